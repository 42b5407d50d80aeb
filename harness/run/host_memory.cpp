#include "run/host_memory.h"

#include <fstream>
#include <string>

namespace penumbra::run {
namespace {

uint64_t status_bytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field + ":", 0) == 0) return std::stoull(line.substr(field.size() + 1)) * 1024;
  return 0;
}

}  // namespace

HostMemoryPeak::HostMemoryPeak() {
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the high-water mark, see proc(5)
  before_ = status_bytes("VmHWM");
}

uint64_t HostMemoryPeak::bytes() const {
  const uint64_t peak = status_bytes("VmHWM");
  return peak > before_ ? peak - before_ : 0;
}

}  // namespace penumbra::run
