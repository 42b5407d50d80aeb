// View samples by how much of the light is above their horizon: all of it, which needs no clipping, a part of it, or
// none, which needs nothing. Each of the two classes gets a depth picture that keeps wedges off all other pixels; the
// class itself stands beside the normal, so that nothing is left to two roundings.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(constant_id = 0) const uint SHAPE = SHAPE_RECTANGLE;
const bool HORIZON = true;
#include "techniques/soft_shadow_volume/shaders/coverage.glsl"
layout(local_size_x = WEDGE_GROUP) in;
layout(push_constant, scalar) uniform Push { ClassifyPush push; };

const bool disc = SHAPE == SHAPE_DISC;

uint class_of(vec4 p, vec3 n) {
  if (p.w == 0.0) return CLASS_DARK;
  if (!disc && dot(cross(push.light.scale_u.xyz, push.light.scale_v.xyz), p.xyz - push.light.center.xyz) <= 0.0)
    return CLASS_DARK;
  const View v = view_of(p.xyz, n, push.light, disc);
  const float reach = disc ? length(v.horizon.xy) : abs(v.horizon.x) + abs(v.horizon.y);
  return v.horizon.z >= reach ? CLASS_WHOLE : v.horizon.z <= -reach ? CLASS_DARK : CLASS_CUT;
}

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.count) return;
  const vec4 p = push.position.at[pixel];
  const vec3 n = push.normal.at[pixel].xyz;
  const uint class_ = class_of(p, n);
  push.classed.at[pixel] = vec4(n, float(class_));
  // A little nearer than P: the far side of a wedge that touches P is drawn.
  const float depth = p.w > 0.0 ? min(1.0001 * push.near_plane / p.w, 1.0) : 0.0;
  push.depth_whole.at[pixel] = class_ == CLASS_WHOLE ? depth : 0.0;
  push.depth_cut.at[pixel] = class_ == CLASS_CUT ? depth : 0.0;
}
