// Line space (`line_space`): the room's entry in the registry.
#pragma once
#include "technique/technique.h"

namespace penumbra {
TechniqueInfo line_space_technique();
}
