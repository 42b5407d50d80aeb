#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  penumbra::test::PENUMBRA_FUZZ_TARGET(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
