// The wedge of each silhouette edge: the points that it hides a part of the light from, which are the points
// y + t (y - x), t >= 0, for y on the edge and x on the light. For a convex light that set is convex: it is the hull of
// the two cones that start from the ends of the edge. A sphere is replaced by a rectangle that hides it. The hull is
// given by its rays in turn (counter-clockwise seen from the far end), each with the end that it starts from.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(local_size_x = WEDGE_GROUP) in;
layout(constant_id = 0) const uint SHAPE = SHAPE_RECTANGLE;
layout(push_constant, scalar) uniform Push { WedgesPush push; };

// Directions wider about the mean than this (cosine) make no hull worth having.
const float widest = 0.1;
// Bounds are wider than the light by this factor, for rounding.
const float wider = 1.0001;

vec3 directions[8];
int count = 0;

vec3 across(vec3 unit) {
  const vec3 a = abs(unit);
  const vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0) : a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
  return normalize(cross(unit, axis));
}

// From both ends away from the corners of a rectangle about the light's centre: sides u and v times lo and hi. That
// both use the same corners makes the hull's sides flat where they go from one end to the other.
void add_rays(vec3 a, vec3 b, vec3 u, vec3 v, vec2 lo, vec2 hi) {
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 4; ++i)
      directions[count++] = normalize((end == 0 ? a : b) - push.light.center.xyz - ((i & 1) != 0 ? hi.x : lo.x) * u -
                                      ((i & 2) != 0 ? hi.y : lo.y) * v);
}

void add_rectangle(vec3 a, vec3 b) {
  add_rays(a, b, push.light.scale_u.xyz / dot(push.light.scale_u.xyz, push.light.scale_u.xyz),
           push.light.scale_v.xyz / dot(push.light.scale_v.xyz, push.light.scale_v.xyz), vec2(-wider), vec2(wider));
}

// Where the tangents from (x, y) to the circle of radius r about the origin meet the x axis. y > r.
vec2 tangents(vec2 from, float r) {
  const float r2 = r * r, d = from.y * from.y - r2, root = sqrt(r2 * r2 * from.x * from.x + d * r2 * dot(from, from));
  return (vec2(-root, root) - r2 * from.x) / d;
}

// A rectangle that hides the sphere from both ends, across the mean direction to them. False where it would have no
// bounds.
bool add_sphere(vec3 a, vec3 b) {
  const vec3 to_a = a - push.light.center.xyz, to_b = b - push.light.center.xyz, mean = normalize(to_a + to_b);
  const float r = push.light.center.w * wider;
  if (!(min(dot(to_a, mean), dot(to_b, mean)) > 1.01 * r)) return false;
  const vec3 edge = b - a, side = edge - mean * dot(edge, mean);
  const vec3 u = dot(side, side) > 1e-8 * dot(edge, edge) ? normalize(side) : across(mean), v = cross(mean, u);
  vec2 lo, hi;
  for (int k = 0; k < 2; ++k) {
    const vec3 axis = k == 0 ? u : v;
    const vec2 s = tangents(vec2(dot(to_a, axis), dot(to_a, mean)), r);
    const vec2 t = tangents(vec2(dot(to_b, axis), dot(to_b, mean)), r);
    lo[k] = min(s.x, t.x), hi[k] = max(s.y, t.y);
  }
  add_rays(a, b, u, v, lo, hi);
  return true;
}

// The four planes of the original about the light's bounding sphere: the farther end is first moved towards the
// light until both are equally far; two planes hold the edge and touch the sphere, two hold an end each.
// False when the sphere reaches the edge. Directions come in turn, and need no hull.
bool loose(inout vec3 a, inout vec3 b) {
  const vec3 center = push.light.center.xyz;
  const float radius = push.light.center.w * wider;
  const float to_a = distance(a, center), to_b = distance(b, center), d = min(to_a, to_b);
  a = center + (a - center) * (d / to_a);
  b = center + (b - center) * (d / to_b);
  const vec3 half_way = 0.5 * (a + b) - center, along = 0.5 * (b - a);
  const float height2 = dot(half_way, half_way), length2 = dot(along, along), r2 = radius * radius;
  if (!(height2 > 1.01 * r2)) return false;
  const vec3 out_ = half_way * inversesqrt(height2);
  const vec3 edge = length2 > 1e-12 * height2 ? along * inversesqrt(length2) : across(out_);
  const vec3 up = cross(out_, edge);
  // In the plane of edge and centre the outer tangents from an end, across it those from the middle.
  const float across_tangent = sqrt(r2 / (height2 - r2));
  const float d2 = height2 + length2, spread = sqrt(length2 / height2), end_tangent = sqrt(r2 / (d2 - r2));
  const float beyond = 1.0 - spread * end_tangent;
  if (!(beyond > widest)) return false;
  const float end = (spread + end_tangent) / beyond;
  directions[0] = normalize(out_ - end * edge - across_tangent * up);
  directions[1] = normalize(out_ + end * edge - across_tangent * up);
  directions[2] = normalize(out_ + end * edge + across_tangent * up);
  directions[3] = normalize(out_ - end * edge + across_tangent * up);
  return true;
}

bool narrow(vec3 mean, int n) {
  float least = 1.0;
  for (int i = 0; i < n; ++i) least = min(least, dot(directions[i], mean));
  return least > widest;
}

// By wrapping: from the leftmost, each time the one that has all others on its left.
uint hull(vec3 mean, inout Wedge w) {
  const vec3 x = across(mean), y = cross(mean, x);
  vec2 at[8];
  int first = 0;
  for (int i = 0; i < 8; ++i) {
    at[i] = vec2(dot(directions[i], x), dot(directions[i], y)) / dot(directions[i], mean);
    if (at[i].x < at[first].x || (at[i].x == at[first].x && at[i].y < at[first].y)) first = i;
  }
  uint n = 0;
  int current = first;
  for (int turn = 0; turn < 8; ++turn) {
    w.ring[n++] = vec4(directions[current], current < 4 ? 0.0 : 1.0);
    int next = -1;
    for (int i = 0; i < 8; ++i) {
      const vec2 to = at[i] - at[current];
      if (i == current || dot(to, to) == 0.0) continue;
      const vec2 best = next < 0 ? vec2(0) : at[next] - at[current];
      const float turn_ = best.x * to.y - best.y * to.x;
      if (next < 0 || turn_ < 0.0 || (turn_ == 0.0 && dot(to, to) > dot(best, best))) next = i;
    }
    if (next < 0 || at[next] == at[first]) break;
    current = next;
  }
  return n;
}

// Nothing is seen beyond the scene's bounds: rays may end on the side of the box that all of them reach soonest.
void end_rays(uint n, inout Wedge w) {
  float soonest = 1e30, plane = 0.0;
  int axis = -1;
  for (int side = 0; side < 6; ++side) {
    const int k = side >> 1;
    const float sign_ = (side & 1) != 0 ? 1.0 : -1.0, at = (side & 1) != 0 ? push.hi[k] : push.lo[k];
    float latest = 0.0;
    for (uint r = 0; r < n; ++r) {
      const float forwards = sign_ * w.ring[r][k], away = sign_ * (at - w.apex[uint(w.ring[r].w)][k]);
      latest = forwards > 0.0 && away >= 0.0 ? max(latest, away / forwards) : 1e30;
      if (latest >= soonest) break;
    }
    if (latest < soonest) soonest = latest, axis = k, plane = at;
  }
  if (axis < 0) return;
  w.apex[0].w = 1.0;
  for (uint r = 0; r < n; ++r) {
    const vec3 from = w.apex[uint(w.ring[r].w)].xyz;
    w.ring[r].xyz = from + (plane - from[axis]) / w.ring[r][axis] * w.ring[r].xyz;
  }
}

void put(uint wedge, uint triangle, uint a, uint b, uint c) {
  const uint at = wedge * WEDGE_INDICES + 3 * triangle, first = wedge * WEDGE_VERTICES;
  push.indices.at[at] = first + a, push.indices.at[at + 1] = first + b, push.indices.at[at + 2] = first + c;
}

// Triangles that face the wedge's inside: sides, which are two triangles where they go from one apex to the other,
// and the far cap. All slots are written; those left over are no triangles.
void put_triangles(uint wedge, uint n, Wedge w) {
  uint t = 0;
  if (n == WHOLE_PICTURE) {  // either way about: one of the two is culled
    put(wedge, t++, 0, 1, 2);
    put(wedge, t++, 0, 2, 1);
  } else {
    for (uint k = 0; k < n; ++k) {
      const uint next = k + 1 < n ? k + 1 : 0, from = uint(w.ring[k].w), to = uint(w.ring[next].w);
      put(wedge, t++, from, 2 + k, 2 + next);
      if (from != to) put(wedge, t++, from, 2 + next, to);
    }
    for (uint k = 1; k + 1 < n; ++k) put(wedge, t++, 2, 2 + k + 1, 2 + k);
  }
  for (; t < WEDGE_INDICES / 3; ++t) put(wedge, t, 0, 0, 0);
}

void main() {
  const uint i = linear_invocation();
  if (i >= push.count) return;
  const Silhouette s = push.silhouettes.at[i];
  const vec3 a = push.positions.at[s.vertex[0]], b = push.positions.at[s.vertex[1]];
  const vec3 center = push.light.center.xyz;
  Wedge w;
  w.edge[0] = vec4(a, float(s.weight)), w.edge[1] = vec4(b, 0);
  w.apex[0] = vec4(a, 0), w.apex[1] = vec4(b, 0);
  for (int k = 0; k < 8; ++k) w.ring[k] = vec4(0);
  uint n = WHOLE_PICTURE;
  bool behind = false, reaches = false;
  if (SHAPE != SHAPE_DISC) {
    const vec3 normal = normalize(cross(push.light.scale_u.xyz, push.light.scale_v.xyz));
    const float ha = dot(normal, a - center), hb = dot(normal, b - center);
    behind = max(ha, hb) <= 0.0;                       // nothing lies between it and the light's front
    reaches = min(ha, hb) <= 1e-3 * push.light.center.w;  // the wedge opens to half of space
  }
  if (behind) {
    n = 0;
  } else if (!reaches) {
    if (push.loose != 0) {
      vec3 p = a, q = b;
      if (loose(p, q) && narrow(normalize(directions[0] + directions[1] + directions[2] + directions[3]), 4)) {
        n = 4;
        w.apex[0].xyz = p, w.apex[1].xyz = q;
        for (int k = 0; k < 4; ++k) w.ring[k] = vec4(directions[k], k == 1 || k == 2 ? 1.0 : 0.0);
      }
    } else {
      bool outside = true;
      if (SHAPE == SHAPE_DISC) {
        outside = add_sphere(a, b);
      } else {
        add_rectangle(a, b);
      }
      const vec3 mean = normalize(a - center + b - center);
      if (outside && narrow(mean, 8)) n = hull(mean, w);
    }
  }
  if (n <= MOST_DIRECTIONS) end_rays(n, w);
  w.edge[1].w = float(n);
  push.wedges.at[i] = w;
  put_triangles(i, n, w);
}
