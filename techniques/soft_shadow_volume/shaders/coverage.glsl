// The part of the light that one edge adds or takes away, seen from a view sample P [SoftShadowVolumes, "Optimized
// Shaders"].
//
// Projection space has P at the origin and the light's plane at z = 1; x and y are in units of the light: the rectangle
// spans -1 to 1, the disc has radius 1. Let w(x) be how many casters' far sides a ray from P to the light's point x
// meets. Casters are closed, so w changes only where the ray meets a silhouette edge, by the edge's weight. The integral
// of w(x) - w(centre) is a sum over edges: each A -> B, clipped to the light, adds what lies beyond it as seen from the
// centre, if the centre is on its right; and takes it away if it is on its left:
//   weight * (area of the triangle (centre, A, B) - area of the light in the sector from A to B), both signed.
// Light points below the horizon of P count for nothing: both areas are clipped by the line where the horizon cuts
// the light's plane. Deviation: the original leaves the horizon to shading. Define HORIZON (a constant) before: false where
// the whole light is above it.
const float pi = 3.14159265358979;

// Of a view sample: what does not depend on the edge.
struct View {
  vec3 p, to_center;
  vec3 row_x, row_y, row_z;  // projection space of a direction from P: (row_x, row_y, row_z) . direction
  vec3 horizon;              // height of light point (x, y) over the horizon: horizon.z + horizon.x x + horizon.y y
};

// The positive share of a triangle, for a linear function with these values at its corners.
float positive_share(float a, float b, float c) {
  if (!HORIZON) return 1.0;
  const float lowest = min(a, min(b, c)), highest = max(a, max(b, c)), middle = a + b + c - lowest - highest;
  const float one = highest * highest / max((highest - lowest) * (highest - middle), 1e-38);
  const float two = 1.0 - lowest * lowest / max((highest - lowest) * (middle - lowest), 1e-38);
  return lowest >= 0.0 ? 1.0 : highest <= 0.0 ? 0.0 : middle <= 0.0 ? min(one, 1.0) : max(two, 0.0);
}

float height(View v, vec2 x) { return v.horizon.z + v.horizon.x * x.x + v.horizon.y * x.y; }

// Signed area above the horizon of the triangle (centre, a, b).
float triangle_area(View v, vec2 a, vec2 b) {
  return 0.5 * (a.x * b.y - a.y * b.x) * positive_share(v.horizon.z, height(v, a), height(v, b));
}

// Sweeps from `from` to `to`, both turns on a closed way of length `all`, the shorter way about; where both ways are
// nearly as long, counter-clockwise if `left`. Returns what to add to `to`.
float turns(float from, float to, float all, bool left) {
  const float d = to - from;
  float added = d > 0.5 * all ? -all : d < -0.5 * all ? all : 0.0;
  const float way = d + added;
  if (left && way < -0.25 * all) added += all;
  if (!left && way > 0.25 * all) added -= all;
  return added;
}

// --- the rectangle -----------------------------------------------------------------------------------------------

vec2 corner(int i) { return vec2(i == 0 || i == 1 ? 1.0 : -1.0, i == 1 || i == 2 ? 1.0 : -1.0); }

// Along the rectangle's border, counter-clockwise from its corner (1, -1): where the ray from the centre through x
// leaves it, 0 to 8.
float border_place(vec2 x) {
  const vec2 a = abs(x);
  const float m = max(max(a.x, a.y), 1e-30);
  return a.x >= a.y ? (x.x >= 0.0 ? 1.0 + x.y / m : 5.0 - x.y / m) : (x.y >= 0.0 ? 3.0 - x.x / m : 7.0 + x.x / m);
}

// Areas above the horizon of the four triangles between the centre and a side.
vec4 quarters(View v) {
  vec4 heights;
  for (int i = 0; i < 4; ++i) heights[i] = height(v, corner(i));
  vec4 q;
  for (int i = 0; i < 4; ++i) q[i] = positive_share(v.horizon.z, heights[i], heights[(i + 1) & 3]);
  return q;
}

// Area above the horizon that is swept from place 0 to `place`.
float swept_rectangle(View v, vec4 q, float place) {
  const int side = int(min(place * 0.5, 3.0));
  const float along = place - 2.0 * float(side);
  const vec2 from = side == 0 ? corner(0) : side == 1 ? corner(1) : side == 2 ? corner(2) : corner(3);
  const vec2 step = side == 0 ? vec2(0, 1) : side == 1 ? vec2(-1, 0) : side == 2 ? vec2(0, -1) : vec2(1, 0);
  const float whole = side == 0 ? 0.0 : side == 1 ? q.x : side == 2 ? q.x + q.y : q.x + q.y + q.z;
  const vec2 to = from + along * step;
  return whole + 0.5 * along * positive_share(v.horizon.z, height(v, from), height(v, to));
}

// Clips t in [from, to] to g0 + t (g1 - g0) >= 0.
void clip(float g0, float g1, inout float from, inout float to) {
  const float t = g0 / (g0 - g1);
  if (g0 < 0.0 && g1 >= 0.0) from = max(from, t);
  if (g1 < 0.0 && g0 >= 0.0) to = min(to, t);
  if (g0 < 0.0 && g1 < 0.0) to = -1.0;
}

// In homogeneous space, as the slides do: nothing is divided before it is clipped. False when nothing is left.
bool clip_to_rectangle(vec3 a, vec3 b, out vec2 from, out vec2 to) {
  float t0 = 0.0, t1 = 1.0;
  clip(a.z - a.x, b.z - b.x, t0, t1);
  clip(a.z + a.x, b.z + b.x, t0, t1);
  clip(a.z - a.y, b.z - b.y, t0, t1);
  clip(a.z + a.y, b.z + b.y, t0, t1);
  clip(1.0 - a.z, 1.0 - b.z, t0, t1);
  const vec3 p = a + t0 * (b - a), q = t1 >= 1.0 ? b : a + t1 * (b - a);
  from = clamp(p.xy / max(p.z, 1e-30), -1.0, 1.0);
  to = clamp(q.xy / max(q.z, 1e-30), -1.0, 1.0);
  return t0 < t1;
}

// --- the disc ----------------------------------------------------------------------------------------------------

// The angle of x to the x axis, -pi to pi; as Cephes' atanf, for atan() may be off by 1e-4 on some devices.
float angle_of(vec2 x) {
  const vec2 a = abs(x);
  const float least = min(a.x, a.y), most = max(max(a.x, a.y), 1e-30), t = least / most;
  const bool upper = t > 0.41421356;
  const float r = upper ? (least - most) / (least + most) : t, z = r * r;
  float angle =
      (((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1) * z * r + r;
  if (upper) angle += 0.25 * pi;
  if (a.y > a.x) angle = 0.5 * pi - angle;
  if (x.x < 0.0) angle = pi - angle;
  return x.y < 0.0 ? -angle : angle;
}

// Where the horizon lies: the part of the disc with dot(x, towards) >= -offset is above it.
struct DiscHorizon {
  vec2 towards;
  float offset, border;  // border: the angle to `towards` at which the horizon meets the circle
};

DiscHorizon disc_horizon(View v) {
  if (!HORIZON) return DiscHorizon(vec2(1, 0), 1.0, pi);
  const float slope = length(v.horizon.xy);
  DiscHorizon h;
  h.towards = slope > 0.0 ? v.horizon.xy / slope : vec2(1, 0);
  h.offset = clamp(v.horizon.z / max(slope, 1e-30), -1.0, 1.0);
  h.border = angle_of(vec2(-h.offset, sqrt((1.0 - h.offset) * (1.0 + h.offset))));
  return h;
}

vec2 turned(DiscHorizon h, vec2 x) { return vec2(dot(h.towards, x), h.towards.x * x.y - h.towards.y * x.x); }

// Area above the horizon that is swept from `towards` to direction d, given relative to `towards`, of this angle.
float swept_disc(DiscHorizon h, vec2 d, float angle) {
  const float a = abs(angle), o = h.offset;
  const bool within = a <= h.border;
  // o^2 times the tangents of a and of the border.
  const float o2_tan = o * o * abs(d.y) / (d.x != 0.0 ? d.x : 1e-30), o2_tan_border = -o * sqrt((1.0 - o) * (1.0 + o));
  float area = 0.5 * (within ? a : h.border);
  if (o < 0.0) area -= 0.5 * (within ? o2_tan : o2_tan_border);
  if (o > 0.0 && o < 1.0 && !within) area += 0.5 * (o2_tan - o2_tan_border);
  return angle < 0.0 ? -area : area;
}

// The slides: "solves the equation of an intersection with a cone and line in homogenous space".
bool clip_to_disc(vec3 a, vec3 b, out vec2 from, out vec2 to) {
  float t0 = 0.0, t1 = 1.0;
  clip(a.z, b.z, t0, t1);
  clip(1.0 - a.z, 1.0 - b.z, t0, t1);
  const vec3 d = b - a;
  // q(t) = qa t^2 + 2 qb t + qc <= 0 within the cone and its mirror image.
  float qa = dot(d.xy, d.xy) - d.z * d.z;
  const float qb = dot(a.xy, d.xy) - a.z * d.z, qc = dot(a.xy, a.xy) - a.z * a.z;
  if (abs(qa) < 1e-30) qa = 1e-30;
  const float root = sqrt(max(qb * qb - qa * qc, 0.0)), s = qb >= 0.0 ? -(qb + root) : root - qb;
  const float r0 = s / qa, r1 = s != 0.0 ? qc / s : r0;
  if (qa > 0.0) {
    t0 = max(t0, min(r0, r1));
    t1 = min(t1, max(r0, r1));
    if (!(qb * qb - qa * qc > 0.0)) t1 = -1.0;
  } else if (d.z > 0.0) {
    t0 = max(t0, max(r0, r1));
  } else {
    t1 = min(t1, min(r0, r1));
  }
  const vec3 p = a + t0 * d, q = t1 >= 1.0 ? b : a + t1 * d;
  from = p.xy / max(p.z, 1e-30);
  to = q.xy / max(q.z, 1e-30);
  from /= max(length(from), 1.0);
  to /= max(length(to), 1.0);
  return t0 < t1;
}

// --- both ----------------------------------------------------------------------------------------------------------

// From the light's centre to its pivot.
vec3 pivot_offset(AreaLight light, bool disc) {
  if (disc) return light.center.w * vec3(PIVOT_X, PIVOT_Y, PIVOT_X);
  return PIVOT_X * light.scale_u.xyz / dot(light.scale_u.xyz, light.scale_u.xyz) +
         PIVOT_Y * light.scale_v.xyz / dot(light.scale_v.xyz, light.scale_v.xyz);
}

View view_of(vec3 p, vec3 normal, AreaLight light, bool disc) {
  View v;
  v.p = p;
  v.to_center = light.center.xyz - p;
  vec3 u, w;  // half the light's extent along x and y
  if (disc) {
    const float d = length(v.to_center);
    v.row_z = v.to_center / (d * d);
    const vec3 away = v.to_center / d, m = abs(away);
    const vec3 axis = m.x <= m.y && m.x <= m.z ? vec3(1, 0, 0) : m.y <= m.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    const vec3 x = normalize(cross(away, axis)), y = cross(x, away);  // x, y, towards P: right-handed
    v.row_x = x / light.center.w, v.row_y = y / light.center.w;
    u = x * light.center.w, w = y * light.center.w;
  } else {
    const vec3 n = cross(light.scale_u.xyz, light.scale_v.xyz);
    v.row_z = n / dot(n, v.to_center);
    v.row_x = light.scale_u.xyz - dot(light.scale_u.xyz, v.to_center) * v.row_z;
    v.row_y = light.scale_v.xyz - dot(light.scale_v.xyz, v.to_center) * v.row_z;
    u = light.scale_u.xyz / dot(light.scale_u.xyz, light.scale_u.xyz);
    w = light.scale_v.xyz / dot(light.scale_v.xyz, light.scale_v.xyz);
  }
  v.horizon = vec3(dot(normal, u), dot(normal, w), dot(normal, v.to_center));
  return v;
}

vec3 project(View v, vec3 y) {
  const vec3 a = y - v.p;
  return vec3(dot(v.row_x, a), dot(v.row_y, a), dot(v.row_z, a));
}

// The light's area above the horizon, of 4 or pi.
float area_above(View v, bool disc) {
  if (disc) return 2.0 * swept_disc(disc_horizon(v), vec2(-1, 0), pi);
  const vec4 q = quarters(v);
  return q.x + q.y + q.z + q.w;
}

// Signed area above the horizon of the light's sector from the ray through a to that through b.
float sector_area(View v, vec2 a, vec2 b, bool left, bool disc) {
  if (disc) {
    const DiscHorizon h = disc_horizon(v);
    const vec2 da = turned(h, a), db = turned(h, b);
    const float from = angle_of(da), to = angle_of(db);
    return swept_disc(h, db, to) - swept_disc(h, da, from) +
           turns(from, to, 2.0 * pi, left) / pi * swept_disc(h, vec2(-1, 0), pi);
  }
  const vec4 q = quarters(v);
  const float from = border_place(a), to = border_place(b);
  return swept_rectangle(v, q, to) - swept_rectangle(v, q, from) +
         turns(from, to, 8.0, left) / 8.0 * (q.x + q.y + q.z + q.w);
}
