// What both kernels that test triangles share: the triangle, the texels that it touches, the test of a range of a row.
//
// Lists are laid out row by row in one dense array, so that the view samples of neighbouring texels of a row stand side
// by side: a triangle's texels in a row are one range of the array, found by two loads, and empty texels cost nothing.
#extension GL_EXT_control_flow_attributes : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
#include "techniques/alias_free_shadow_map/shaders/corners.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool COUNTING = false;
layout(push_constant, scalar) uniform Push { CastPush push; };

layout(set = 0, binding = 1) uniform usampler2D lists;    // view samples in the order of the lists
layout(set = 0, binding = 2, std140) uniform Block { LightView f; } block;

// A caster in one face, and the conservative bounds of its texels.
struct Footprint {
  vec3 edges[3];      // (u, v, 1) on the inner side of all three, padded: may touch the triangle
  vec2 lo, hi;        // texels, continuous, not yet clamped to the face
};

// What is the same for all triangles: an invocation loads it once for several of them.
struct View {
  Face face;
  vec3 center;
  vec4 light;
  uint grid_size;
};
View load_view() {
  return View(block.f.faces[push.face], block.f.center.xyz, block.f.light, block.f.grid_size);
}

// The plane through the light and the edge a-b, relative to View::center: positive where c of (a, b, c) is, when the
// triangle turns away from the light.
vec4 edge_plane(vec3 a, vec3 b, vec4 light) {
  const vec3 along = b - a, ray = PARALLEL ? -light.xyz : a;
  const vec3 n = cross(ray, along);
  return vec4(n, PARALLEL ? -dot(n, a) : 0.0);
}

// Bounds in whole-face terms where a corner is not before the light: the edges alone then bound the rows' ranges.
Footprint footprint(const Caster caster, const View view) {
  const Face face = view.face;
  const vec3 corners[3] = vec3[](caster.a - view.center, caster.b - view.center, caster.c - view.center);
  Footprint f;
  const float inner = caster.light_side < 0.0 ? 1.0 : -1.0;
  f.lo = vec2(3e38), f.hi = vec2(-3e38);
  bool behind = false;
  [[unroll]] for (int k = 0; k < 3; ++k) {
    const vec3 q = corners[k];
    const vec4 e = edge_plane(q, corners[(k + 1) % 3], view.light) * inner;
    const float error = 2e-6 * ((abs(e.x) + abs(e.y) + abs(e.z)) * face.slack.z + abs(e.w));
    f.edges[k] = vec3(dot(e.xyz, face.right.xyz), dot(e.xyz, face.down.xyz),
                      (PARALLEL ? e.w : dot(e.xyz, face.forward.xyz)) + error);
    const vec3 p = project(face, q);
    behind = behind || (!PARALLEL && !(p.z > 1e-6 * (abs(q.x) + abs(q.y) + abs(q.z))));
    const vec2 at = (p.xy - face.window.xy) * face.window.zw;
    const vec2 slack = face.slack.xy + 8e-6 * abs(p.xy) * face.window.zw;
    f.lo = min(f.lo, at - slack);
    f.hi = max(f.hi, at + slack);
  }
  f.lo = behind ? vec2(-1e30) : f.lo;
  f.hi = behind ? vec2(1e30) : f.hi;
  return f;
}

// First and last row of texels; none when first > last.
ivec2 rows_of(const Footprint f, int grid_size) {
  const float last = float(grid_size - 1);
  if (!(f.hi.x >= 0.0 && f.lo.x <= last + 1.0 && f.hi.y >= 0.0 && f.lo.y <= last + 1.0)) return ivec2(0, -1);
  return ivec2(clamp(vec2(f.lo.y, f.hi.y), 0.0, last));
}

// The view samples of the texels of row y that the triangle may touch: [x, y) of the array.
uvec2 row_range(const Footprint f, const View view, int y) {
  const Face face = view.face;
  const uint grid_size = view.grid_size;
  const float v0 = face.window.y + (float(y) - face.slack.y) / face.window.w;
  const float v1 = face.window.y + (float(y + 1) + face.slack.y) / face.window.w;
  float u0 = -3e38, u1 = 3e38;
  [[unroll]] for (int k = 0; k < 3; ++k) {
    const float slope = f.edges[k].x, rest = max(f.edges[k].y * v0, f.edges[k].y * v1) + f.edges[k].z;
    const float bound = -rest / slope;
    u0 = slope > 0.0 ? max(u0, bound) : u0;
    u1 = slope < 0.0 ? min(u1, bound) : u1;
    u1 = slope == 0.0 && rest < 0.0 ? -3e38 : u1;
  }
  const float last = float(grid_size - 1u);
  const float x0 = max((u0 - face.window.x) * face.window.z - face.slack.x, f.lo.x);
  const float x1 = min((u1 - face.window.x) * face.window.z + face.slack.x, f.hi.x);
  if (!(x0 <= x1 && x0 <= last + 1.0 && x1 >= 0.0)) return uvec2(0u);
  const uint row = (push.face * grid_size + uint(y)) * grid_size;
  return uvec2(push.offsets.at[row + uint(clamp(x0, 0.0, last))], push.offsets.at[row + uint(clamp(x1, 0.0, last)) + 1u]);
}

// Whoever hides a view sample writes the same word: nothing is lost between them.
void test(uint t, const Caster caster, vec4 light, uint begin, uint end) {
  for (uint slot = begin; slot < end; ++slot) {
    const uvec4 s = texelFetch(lists, ivec2(slot & 8191u, slot >> 13u), 0);
    if (hides(caster, uintBitsToFloat(s.xyz), light) && s.w != t) push.blocked.at[slot] = 1u;
  }
}

void count_pairs(uint pairs) {
  if (!COUNTING || pairs == 0u) return;
  const uint before_it = atomicAdd(push.progress.p.pairs[0], pairs);
  if (before_it + pairs < before_it) atomicAdd(push.progress.p.pairs[1], 1u);
}
