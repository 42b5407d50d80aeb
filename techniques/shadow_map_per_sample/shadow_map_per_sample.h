// Soft shadows as the mean of conventional shadow maps, one per light sample: README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo shadow_map_per_sample_technique();

}  // namespace penumbra
