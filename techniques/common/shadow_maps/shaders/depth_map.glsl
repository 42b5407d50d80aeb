// Reading the depth map. The including shader declares map_size and `layers`, a LayerArray.
layout(set = 0, binding = 0) uniform sampler2DArray depth_map;

float depth_at(ivec2 texel, uint layer) {
  return texelFetch(depth_map, ivec3(clamp(texel, ivec2(0), ivec2(map_size - 1)), layer), 0).r;
}

// Distance along the map's axis of what a texel shows.
float linear_depth(const MapLayer layer, vec2 texel_center, float depth) {
  vec2 ndc = texel_center * (2.0 / map_size) - 1;
  if (layer.log_warp.x != 0) ndc.y = -exp((layer.log_warp.y - ndc.y) / layer.log_warp.x);
  const vec4 v = vec4(ndc, depth, 1);
  return dot(layer.linear_numerator, v) / dot(layer.linear_denominator, v);
}
