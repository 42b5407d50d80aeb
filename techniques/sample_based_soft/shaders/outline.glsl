// The outline of a triangle's influence region on the plane at the farthest view sample: the convex hull of the light's
// bounding polygon projected through each corner [Sintorn2008, sec. 4.1]. A rectangle bounds itself; of a sphere, seen
// from a corner, the silhouette is a circle, and a hexagon around it bounds it.
//
// Gift wrapping: with all points in registers, a turn is a scan over them.
const uint POINTS_OF_CORNER = BALL ? 6u : 4u, POINTS = 3u * POINTS_OF_CORNER;

// Where the light's point L is hidden by v, see region.glsl; beyond the plane, where v itself is seen.
vec2 hidden(vec3 v, vec3 L, float w, float near, inout bool bounded) {
  bounded = bounded && v.z - L.z > near;
  float q = (1.0 - L.z * w) / (v.z - L.z);
  return v.z * w < 1.0 ? L.xy * w + (v.xy - L.xy) * q : v.xy / v.z;
}

vec3 bounding_point(FrameConstants f, vec3 v, uint k, inout bool bounded) {
  if (!BALL)
    return vec3(((k & 1u) == 0u ? f.light_lo.x : f.light_hi.x), ((k >> 1u) == 0u ? f.light_lo.y : f.light_hi.y), 0.0) - vec3(f.eye.xy, 0.0);
  float d2 = dot(v, v), inverse = 1.0 / d2;
  bounded = bounded && d2 > 1.0001;
  // A little more than the hexagon's 1 / cos(30 degrees), for rounding.
  float radius = 1.1548 * sqrt(max(1.0 - inverse, 0.0));
  vec3 other = abs(v.x) < 0.6 * sqrt(d2) ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 x = normalize(cross(v, other)), y = normalize(cross(v, x));
  float angle = float(k) * 1.04719755;
  return v * inverse + (x * cos(angle) + y * sin(angle)) * radius;
}

// Stores the sides: points of the region have dot(xy, uv) <= z. Returns how many; 0 where it has no end.
uint outline(FrameConstants f, vec3 a, vec3 b, vec3 c, bool in_block, uint caster) {
  float w = 1.0 / from_ordered(~pc.header.h.farthest);
  vec2 at[POINTS];
  bool bounded = in_block;
  vec2 lowest_ = vec2(1e30);
  [[unroll]] for (uint i = 0u; i < POINTS; i++) {
    vec3 v = (i / POINTS_OF_CORNER == 0u ? a : i / POINTS_OF_CORNER == 1u ? b : c) - f.eye.xyz;
    vec3 L = bounding_point(f, v, i % POINTS_OF_CORNER, bounded);
    at[i] = hidden(v, L, w, f.near, bounded);
    bool first = at[i].y < lowest_.y || (at[i].y == lowest_.y && at[i].x < lowest_.x);
    lowest_ = first ? at[i] : lowest_;
  }
  if (!bounded) return 0u;
  vec2 here = lowest_;
  uint sides = 0u;
  float size = 0.0;
  [[unroll]] for (uint i = 0u; i < POINTS; i++) size = max(size, max(abs(at[i].x), abs(at[i].y)));
  do {
    vec2 next = here;
    float next_length = 0.0;
    [[unroll]] for (uint i = 0u; i < POINTS; i++) {
      vec2 d = at[i] - here, e = next - here;
      float side = e.x * d.y - e.y * d.x, length_ = dot(d, d);
      bool better = length_ > 0.0 && (next_length == 0.0 || side < 0.0 || (side == 0.0 && length_ > next_length));
      next = better ? at[i] : next;
      next_length = better ? length_ : next_length;
    }
    if (next_length == 0.0) break;
    vec2 n = vec2(next.y - here.y, here.x - next.x) * inversesqrt(next_length);
    // The largest of all points and not the side's own: rounding then never cuts anything off.
    float most = -1e30;
    [[unroll]] for (uint i = 0u; i < POINTS; i++) most = max(most, dot(n, at[i]));
    float slack = 8e-6 * size + 4.0 * f.pad * w * (1.0 + size);
    pc.hulls.at[caster * POINTS + sides] = vec4(n, most + slack, 0.0);
    sides++;
    here = next;
  } while (sides < POINTS && here != lowest_);
  return sides;
}
