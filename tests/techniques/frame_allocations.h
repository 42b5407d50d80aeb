// What a technique's frame allocates, by count and not by report.
#pragma once
#include "gpu/pass_recorder.h"
#include "tests/support/allocation_count.h"

namespace penumbra::testing {

// Allocations of one render(), less those of a recorder that records as many passes of the same names.
template <class Render>
long frame_allocations(gpu::PassRecorder& passes, const Render& render) {
  passes.take_times();
  const long before = allocation_count();
  render();
  const long with_passes = allocation_count() - before;
  const std::vector<gpu::PassTime> names = passes.take_times();
  const long between = allocation_count();
  for (const gpu::PassTime& pass : names) passes.host_pass(pass.name, [] {});
  const long of_passes = allocation_count() - between;
  passes.take_times();
  return with_passes - of_passes;
}

}  // namespace penumbra::testing
