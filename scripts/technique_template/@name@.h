// @title@ (`@name@`): the room's entry in the registry.
#pragma once
#include "technique/technique.h"

namespace penumbra {
TechniqueInfo @name@_technique();
}
