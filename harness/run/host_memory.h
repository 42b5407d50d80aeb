// The process's peak of resident memory over a stretch of work.
#pragma once
#include <cstdint>

namespace penumbra::run {

// Bytes that the process had resident at most since this object was made, beyond what it had then. Where the
// kernel does not let the high-water mark be reset, growth of the mark is all that can be seen (0 below an
// older peak).
class HostMemoryPeak {
 public:
  HostMemoryPeak();
  uint64_t bytes() const;

 private:
  uint64_t before_ = 0;
};

}  // namespace penumbra::run
