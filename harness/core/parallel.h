// Data-parallel loops on oneTBB, the scheduler that Embree brings. set_threads() bounds all of them.
#pragma once
#include <cstddef>
#include <functional>

namespace penumbra {

// Number of threads that host work uses: hardware threads unless set_threads() said otherwise.
int thread_count();
// Bounds host work to n >= 1 threads, for the life of the process. Call before any parallel work.
void set_threads(int n);

// Calls body(begin, end) on disjoint ranges covering [0, count), ranges of at most `grain` elements.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace penumbra
