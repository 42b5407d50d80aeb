// Sample based soft shadows [Sintorn2008, sec. 4]: lists of view samples in the light's view, the influence
// region of each triangle, and per view sample a mask of the light samples behind the planes of its edges.
// README.md says what is built.
#pragma once
#include "technique/technique.h"

namespace penumbra {

TechniqueInfo sample_based_soft_technique();

}  // namespace penumbra
