// Buffer references to the room's own structs.
#include "gpu/shaders/common.glsl"

layout(buffer_reference) buffer ListsRef;
layout(buffer_reference) buffer DrawsRef;
#include "techniques/stencil_shadow_volume/shaders/shared.h"
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ListsRef { Lists lists; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DrawsRef { Draws draws; };
