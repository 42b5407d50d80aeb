// Shadow volumes counted in the stencil [Crow 1977; Heidmann 1991]: README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo stencil_shadow_volume_technique();
// A hard shadow for each light sample, averaged.
TechniqueInfo stencil_shadow_volume_per_sample_technique();

}  // namespace penumbra
