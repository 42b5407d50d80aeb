// Buffer references to the depth map's own structs.
#include "gpu/shaders/common.glsl"

layout(buffer_reference) buffer QueryArray;
layout(buffer_reference) buffer BoundsArray;
layout(buffer_reference) buffer LayerArray;
#include "techniques/shadow_map/shaders/shared.h"
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer QueryArray { FitQuery at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer BoundsArray { SampleBounds at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LayerArray { MapLayer at[]; };

// Whether the light shines on the side of a surface that the viewer sees: above its horizon, in a spot's cone, in front
// of a rectangle.
bool may_be_lit(vec3 point, vec3 normal, vec4 light, vec4 emission) {
  const vec3 to_light = light.xyz - light.w * point;
  return dot(normal, to_light) > 0 && (emission.w <= -1 || dot(emission.xyz, -to_light) >= emission.w * length(to_light));
}
