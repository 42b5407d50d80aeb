// Alias-free shadow maps [Sintorn2008, sec. 3]: lists of view samples in the light's view, tested exactly
// against every shadow-casting triangle. README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo alias_free_shadow_map_technique();

}  // namespace penumbra
