// In builds with the address sanitizer alone: what a driver leaks is known to be the driver's only while it
// is loaded, and the loader unloads it with the instance.
#include "gpu/keep_drivers.h"

#if defined(__SANITIZE_ADDRESS__)
#include <dlfcn.h>
#include <link.h>

#include <cstring>
#include <string>
#include <vector>

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_\nleak:libVkLayer_\nleak:libLLVM\n";
}

namespace penumbra::gpu {

void keep_drivers() {
  std::vector<std::string> names;
  ::dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void* found) {
        if (std::strstr(library->dlpi_name, "libvulkan_") || std::strstr(library->dlpi_name, "libVkLayer_"))
          static_cast<std::vector<std::string>*>(found)->emplace_back(library->dlpi_name);
        return 0;
      },
      &names);
  for (const std::string& name : names) ::dlopen(name.c_str(), RTLD_NOW | RTLD_NODELETE);
}

}  // namespace penumbra::gpu
#else
void penumbra::gpu::keep_drivers() {}
#endif
