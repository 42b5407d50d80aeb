// Buffers of the room.
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/light_basis.glsl"
#include "techniques/common/shaders/ordered_float.glsl"
#include "techniques/sample_based_soft/shaders/shared.h"
layout(buffer_reference, std430, buffer_reference_align = 16) buffer FrameRef { FrameConstants f; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer HeaderRef { Header h; };

const uint no_sample = 0xffffffffu;
const uint no_triangle = 0xffffffffu;
#include "techniques/sample_based_soft/shaders/constants.h"

float from_ordered(uint u) { return uintBitsToFloat((u & 0x80000000u) != 0u ? u & 0x7fffffffu : ~u); }
