// The techniques that configs under test may name.
#pragma once
#include "technique/technique.h"

namespace penumbra::test {

// registry_all.cpp: the real ones. registry_few.cpp: names and a parameter of each kind, nothing that
// renders, so that libFuzzer's programs need no device code.
const Registry& fuzz_registry();

}  // namespace penumbra::test
