#include "tests/support/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <new>

static std::atomic<long> allocations{0};

// Replaces the global operators of every program that links allocation_count().
void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* p = std::malloc(bytes)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace penumbra::testing {
long allocation_count() { return allocations; }
}  // namespace penumbra::testing
