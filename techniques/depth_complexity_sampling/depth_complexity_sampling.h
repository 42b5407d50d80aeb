// Depth complexity sampling (`depth_complexity_sampling`): the room's entry in the registry.
#pragma once
#include "technique/technique.h"

namespace penumbra {
TechniqueInfo depth_complexity_sampling_technique();
}
