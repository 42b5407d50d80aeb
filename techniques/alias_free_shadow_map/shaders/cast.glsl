// What both kernels that test triangles share: the triangle, the texels that it touches, the test of a range of a row.
//
// Lists are laid out row by row in one dense array, so that the view samples of neighbouring texels of a row stand side
// by side: a triangle's texels in a row are one range of the array, found by two loads, and empty texels cost nothing.
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
#include "techniques/alias_free_shadow_map/shaders/predicates.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool COUNTING = false;
layout(constant_id = 2) const bool INNER = false;   // the second pass: triangles of closed meshes that face the light
layout(push_constant, scalar) uniform Push { CastPush push; };

// A caster in one face, and the conservative bounds of its texels.
struct Footprint {
  vec3 edges[3];      // (u, v, 1) on the inner side of all three, padded: may touch the triangle
  vec2 lo, hi;        // texels, continuous, not yet clamped to the face
};

// `entry`: 2 triangle + (of a closed mesh ? 1 : 0).
Caster load_caster(uint entry) {
  const uint t = entry >> 1u;
  const vec3 center = push.frame.f.center.xyz;
  const uint i = 3u * t;
  const vec3 a = push.positions.at[push.indices.at[i]] - center, b = push.positions.at[push.indices.at[i + 1u]] - center,
             c = push.positions.at[push.indices.at[i + 2u]] - center;
  return make_caster(a, b, c, push.frame.f.light);
}

uint entry_of(uint t) { return 2u * t + (push.closed.at[t >> 5u] >> (t & 31u) & 1u); }

bool casts(uint entry, const Caster caster) {
  const bool closed = (entry & 1u) != 0u;
  const bool front = caster.light_side > 0.0 && (INNER ? closed : !closed || push.frame.f.both_faces != 0u);
  // Closed meshes' triangles that turn away must meet their own view samples, see test().
  const bool meets_own = closed && !INNER;
  return (front || (!INNER && caster.light_side < 0.0)) &&
         !hides_nothing(caster, push.frame.f.sample_lo.xyz, push.frame.f.sample_hi.xyz, meets_own);
}

// Bounds in whole-face terms where a corner is not before the light: the edges alone then bound the rows' ranges.
Footprint footprint(const Caster caster, const Face face) {
  Footprint f;
  const float inner = caster.light_side < 0.0 ? 1.0 : -1.0;
  for (int k = 0; k < 3; ++k) {
    const vec4 e = caster.edges[k] * inner;
    const float error = 2e-6 * ((abs(e.x) + abs(e.y) + abs(e.z)) * face.slack.z + abs(e.w));
    f.edges[k] = vec3(dot(e.xyz, face.right.xyz), dot(e.xyz, face.down.xyz),
                      (PARALLEL ? e.w : dot(e.xyz, face.forward.xyz)) + error);
  }
  f.lo = vec2(3e38), f.hi = vec2(-3e38);
  bool behind = false;
  for (int k = 0; k < 3; ++k) {
    const vec3 q = k == 0 ? caster.a : k == 1 ? caster.b : caster.c;
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
uvec2 row_range(const Footprint f, const Face face, int y, uint grid_size) {
  const float v0 = face.window.y + (float(y) - face.slack.y) / face.window.w;
  const float v1 = face.window.y + (float(y + 1) + face.slack.y) / face.window.w;
  float u0 = -3e38, u1 = 3e38;
  for (int k = 0; k < 3; ++k) {
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

// Sets `bits` of the array of bits, bit 0 of which is that of `slot`.
void set_blocked(uint slot, uint bits) {
  const uint low = bits << (slot & 31u), high = (slot & 31u) == 0u ? 0u : bits >> (32u - (slot & 31u));
  if (low != 0u) atomicOr(push.blocked.at[slot >> 5u], low);
  if (high != 0u) atomicOr(push.blocked.at[(slot >> 5u) + 1u], high);
}

// A view sample that faces the light on a triangle of a closed mesh that does not is seen from the mesh's inside:
// through a silhouette's rounding, or by a camera within. There, light comes in through triangles that face it.
void add_inner(uint slot, uint bits) {
  do {
    if (bits != 0u) {
      const uint place = atomicAdd(push.progress.p.inner_count, 1u);
      if (place < most_inner) push.progress.p.inner[place] = slot + uint(findLSB(bits));
      bits &= bits - 1u;
    }
  } while (bits != 0u);
}

// At most 32 view samples from `slot` on. Bits are gathered first: atomics cost more than tests.
void test(uint entry, const Caster caster, uint slot, uint count) {
  const uint t = entry >> 1u;
  uint hidden = 0u, inner = 0u;
  for (uint i = 0u; i < count; ++i) {
    const uvec4 s = push.lists.at[slot + i];
    const bool own = s.w == t;
    hidden |= hides(caster, uintBitsToFloat(s.xyz)) && !own ? 1u << i : 0u;
    inner |= own ? 1u << i : 0u;
  }
  set_blocked(slot, hidden);
  if (!INNER && (entry & 1u) != 0u && caster.light_side < 0.0) add_inner(slot, inner);
}

void count_pairs(uint pairs) {
  if (!COUNTING || pairs == 0u) return;
  const uint before_it = atomicAdd(push.progress.p.pairs[0], pairs);
  if (before_it + pairs < before_it) atomicAdd(push.progress.p.pairs[1], 1u);
}
