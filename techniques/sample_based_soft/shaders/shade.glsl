// What the kernels of coherent shading include.
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
struct FrameConstants { uint unused; };
struct Header { uint unused; };
layout(buffer_reference) buffer FrameRef { FrameConstants f; };
layout(buffer_reference) buffer HeaderRef { Header h; };
#include "techniques/sample_based_soft/shaders/constants.h"
