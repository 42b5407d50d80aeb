#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <memory>

namespace penumbra {
namespace {
std::unique_ptr<tbb::global_control> limit;
}

int thread_count() {
  return limit ? static_cast<int>(
                     tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))
               : tbb::info::default_concurrency();
}

void set_threads(int n) {
  limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                static_cast<std::size_t>(n));
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, grain),
      [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); }, tbb::simple_partitioner{});
}

}  // namespace penumbra
