#extension GL_EXT_control_flow_attributes : require
#include "techniques/common/shaders/light_basis.h"
#include "techniques/common/shaders/texels.glsl"
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer LightBasisRef { LightBasis b; };

// A LightBasis that is the beginning of an array of texels.
LightBasis light_basis(Texels array) {
  LightBasis b;
  b.row_x = texel(array, 0u);
  b.row_y = texel(array, 1u);
  b.row_z = texel(array, 2u);
  b.origin = texel(array, 3u);
  [[unroll]] for (uint c = 0u; c < 8u; c++) b.corners[c] = texel(array, 4u + c);
  uvec4 last = floatBitsToUint(texel(array, 12u));
  b.corner_count = last.x;
  b.front_only = last.y;
  return b;
}

// Always the same expression, so that equal points stay equal.
vec3 to_working(LightBasis b, vec3 world) {
  precise vec3 d = world - b.origin.xyz;
  precise vec3 w = vec3(b.row_x.x * d.x + b.row_x.y * d.y + b.row_x.z * d.z,
                        b.row_y.x * d.x + b.row_y.y * d.y + b.row_y.z * d.z,
                        b.row_z.x * d.x + b.row_z.y * d.y + b.row_z.z * d.z);
  return w;
}

// False when no point of the light can be above the horizon of the view sample P' = o with normal n, or o is behind the
// light. `slack`: more than |P' - P|.
bool reachable(LightBasis b, vec4 o, vec3 n, float slack) {
  float highest_ = -1e30;
  // Unrolled: a corner at a place that varies would be loaded lane by lane.
  [[unroll]] for (uint c = 0u; c < 8u; c++) {
    float height = c < b.corner_count ? dot(n, b.corners[c].xyz - o.xyz * b.corners[c].w) : -1e30;
    highest_ = height > highest_ ? height : highest_;
  }
  bool above = highest_ > -slack;
  bool front = b.front_only == 0u || dot(b.row_z.xyz, o.xyz - b.origin.xyz) > -slack * length(b.row_z.xyz);
  return o.w != 0.0 && above && front;
}
