// Ray tracing with Embree (`ray_tracing`): the room's entry in the registry.
#pragma once
#include "technique/technique.h"

namespace penumbra {
TechniqueInfo ray_tracing_technique();
}
