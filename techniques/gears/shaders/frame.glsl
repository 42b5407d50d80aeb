// Buffers of the room.
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/light_basis.glsl"
#include "techniques/gears/shaders/shared.h"
layout(buffer_reference, std430, buffer_reference_align = 16) buffer FrameRef { FrameConstants f; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer HeaderRef { Header h; };

const uint no_sample = 0xffffffffu;
const uint no_triangle = 0xffffffffu;
#include "techniques/gears/shaders/constants.h"
