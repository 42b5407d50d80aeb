// Which layer a receiver uses, and where it falls in it.

// Cascades are chosen by view depth, faces by the dominant axis of the direction from the light (+x -x +y -y +z -z).
uint layer_of(float view_depth, vec3 from_light) {
  if (faces) {
    const vec3 a = abs(from_light);
    const uint axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (from_light[axis] < 0 ? 1 : 0);
  }
  uint layer = 0;
  while (layer + 1 < push.layer_count && view_depth >= push.layers.at[layer].range.y) ++layer;
  return layer;
}

// A pixel's step to the right and downwards, in texels: derivatives along the receiver's plane, exact also where
// neighbouring pixels show something else.
mat2 footprint(uint layer, vec3 point, vec3 normal, float view_depth) {
  const vec3 along = (point - push.camera.at[0].xyz) / view_depth;
  const float facing = min(dot(normal, along), -1e-6);   // normals face the viewer
  const vec4 clip = push.layers.at[layer].clip_from_world * vec4(point, 1);
  const vec2 ndc = clip.xy / clip.w;
  const vec4 log_warp = push.layers.at[layer].log_warp;
  mat2 texels;
  for (int i = 0; i < 2; ++i) {
    const vec3 at_unit_depth = push.camera.at[1 + i].xyz;
    const vec3 on_plane = view_depth * (at_unit_depth - along * (dot(normal, at_unit_depth) / facing));
    const vec4 moved = push.layers.at[layer].clip_from_world * vec4(on_plane, 0);
    texels[i] = (moved.xy - ndc * moved.w) / clip.w;
    if (log_warp.x != 0) texels[i].y *= -log_warp.x / ndc.y;   // dy' / dy of y' = s log(-1 / y) + o
    texels[i] *= 0.5 * map_size;
  }
  return texels;
}

struct Receiver {
  uint layer;
  vec2 texel;    // continuous texel coordinates: texel i covers [i, i + 1)
  float depth;   // in the map's depth, bias included
  float linear;  // distance along the map's axis, bias included
  vec2 slope;    // depth that the receiver's plane gains per texel in x and y
};

// `point` is the receiver, already moved towards the light.
Receiver locate(uint layer, vec3 point, vec3 normal) {
  const vec4 clip = push.layers.at[layer].clip_from_world * vec4(point, 1);
  vec3 ndc = clip.xyz / clip.w;
  // The plane a x + b y + c z + d = 0 gains -a / c in z per unit of x. Edge-on planes are held to the map's whole range.
  const vec4 plane = push.layers.at[layer].plane_from_world * vec4(normal, -dot(normal, point));
  vec2 slope = abs(plane.z) > 1e-6 * (abs(plane.x) + abs(plane.y)) ? -plane.xy / plane.z : vec2(0);
  const vec4 log_warp = push.layers.at[layer].log_warp;
  if (log_warp.x != 0) {
    slope.y *= -ndc.y / log_warp.x;   // dy / dy' of y' = s log(-1 / y) + o
    ndc.y = log_warp.x * log(-1 / ndc.y) + log_warp.y;
  }
  const vec4 linear = push.layers.at[layer].linear_from_world;
  return Receiver(layer, (ndc.xy * 0.5 + 0.5) * map_size, ndc.z, dot(linear.xyz, point) + linear.w,
                  clamp(slope * (2.0 / map_size), -1, 1));
}
