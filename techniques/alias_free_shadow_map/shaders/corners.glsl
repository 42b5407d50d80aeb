// Triangles by their corners, fetched from an image: on lavapipe a load by address is a loop over lanes and components,
// several times slower.
#include "techniques/common/shaders/texels.glsl"
#include "techniques/alias_free_shadow_map/shaders/predicates.glsl"
layout(set = 0, binding = 0) uniform sampler2D corners;   // 3 texels per triangle, as gather_corners.comp writes them

Caster load_caster(uint t, vec4 light) {
  const uint i = 3u * t;
  return make_caster(texel(corners, i).xyz, texel(corners, i + 1u).xyz, texel(corners, i + 2u).xyz, light);
}
bool in_closed_mesh(uint t) { return texel(corners, 3u * t).w != 0.0; }
