// Shadows projected onto one plane [Blinn 1988; Heckbert and Herf 1997]: README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo planar_shadow_technique();

}  // namespace penumbra
