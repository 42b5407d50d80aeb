#include "techniques/registry.h"
#include "tests/fuzz/registry.h"

namespace penumbra::test {

const Registry& fuzz_registry() {
  static const Registry registry = all_techniques();
  return registry;
}

}  // namespace penumbra::test
