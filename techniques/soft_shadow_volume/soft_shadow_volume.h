// Soft shadows from penumbra wedges [SoftShadowVolumes]: README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo soft_shadow_volume_technique();

}  // namespace penumbra
