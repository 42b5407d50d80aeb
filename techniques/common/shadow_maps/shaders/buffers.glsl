// Buffer references to the depth map's own structs.
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/light_emission.glsl"

layout(buffer_reference) buffer QueryArray;
layout(buffer_reference) buffer BoundsArray;
layout(buffer_reference) buffer LayerArray;
#include "techniques/common/shadow_maps/shaders/shared.h"
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer QueryArray { FitQuery at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer BoundsArray { SampleBounds at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LayerArray { MapLayer at[]; };
