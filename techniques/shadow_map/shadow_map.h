// Shadow mapping [Williams 1978] and what grew out of it, as one technique: README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo shadow_map_technique();

}  // namespace penumbra
