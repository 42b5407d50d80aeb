layout(set = 0, binding = 0) uniform sampler2D frame_texels;   // FrameConstants

// What making casters needs of them.
FrameConstants caster_constants() {
  FrameConstants f;
  f.light = light_basis(frame_texels);
  f.light_lo = texel(frame_texels, light_lo_texel);
  f.light_hi = texel(frame_texels, light_hi_texel);
  f.eye = texel(frame_texels, eye_texel);
  vec4 limits = texel(frame_texels, pad_texel);
  f.pad = limits.x;
  f.near = limits.y;
  f.scene_middle = texel(frame_texels, scene_texel);
  [[unroll]] for (uint k = 0u; k < 3u; k++) f.scene_sides[k] = texel(frame_texels, scene_texel + 1u + k);
  return f;
}

// Corner i of the index list, in working space. Always the same expression, so that common corners stay common.
vec3 corner(LightBasis light, uint i) {
  uint v = 3u * pc.indices.at[i];
  return to_working(light, vec3(pc.positions.at[v], pc.positions.at[v + 1u], pc.positions.at[v + 2u]));
}
