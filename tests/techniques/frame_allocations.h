// What a technique's frame allocates, by count and not by report.
#pragma once
#include <algorithm>

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

// Of several frames the fewest: a thread that takes part for the first time allocates its own once, what a
// frame needs comes back in each.
template <class Render>
long fewest_frame_allocations(gpu::PassRecorder& passes, const Render& render) {
  long fewest = frame_allocations(passes, render);
  for (int i = 0; i < 7; ++i) fewest = std::min(fewest, frame_allocations(passes, render));
  return fewest;
}

}  // namespace penumbra::testing
