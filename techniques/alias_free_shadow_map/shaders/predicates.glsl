// The exact test of a triangle against a view sample.
//
// All points are relative to the light (at infinity: to the scene's middle), so that the light is the origin (or the
// direction `towards`). A triangle hides a view sample q when q lies on the other side of the triangle's plane than the
// light, and on the inner side of the three planes through the light and an edge.
//
// Watertight: the plane of an edge is one fixed expression of its ends in a fixed order, whichever triangle asks, so
// that two triangles that share an edge see values of exactly opposite sign; zero counts as inside for both. `precise`
// keeps the compiler from fusing products in one of them only.

bool before(vec3 a, vec3 b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// Plane (normal, constant) through the light and the edge a-b; c of the counter-clockwise triangle (a, b, c) has the
// sign of dot(cross(a, b), c). The difference of the ends, not the far end, enters the product: its rounding error
// scales with the edge and not with the distance.
vec4 edge_plane(vec3 a, vec3 b, vec4 light) {
  const bool swap = before(b, a);
  const vec3 from = swap ? b : a, to = swap ? a : b;
  precise vec3 along = to - from;
  // Without branches: the position of a light (w = 1) times 0, or the edge's end times 0, leaves the other as it is.
  precise vec3 ray = from * light.w - light.xyz * (1.0 - light.w);
  precise vec3 normal = vec3(ray.y * along.z - ray.z * along.y, ray.z * along.x - ray.x * along.z,
                             ray.x * along.y - ray.y * along.x);
  precise float constant = (light.w - 1.0) * (normal.x * from.x + normal.y * from.y + normal.z * from.z);
  return vec4(normal, constant) * (swap ? -1.0 : 1.0);
}

float edge_side(vec4 plane, vec3 q) {
  precise float e = plane.x * q.x + plane.y * q.y + plane.z * q.z + plane.w;
  return e;
}

float plane_side(vec3 normal, vec3 corner, vec3 q) {
  precise float s = normal.x * (q.x - corner.x) + normal.y * (q.y - corner.y) + normal.z * (q.z - corner.z);
  return s;
}

struct Caster {
  vec4 edges[3];
  vec3 a, b, c, normal;
  float light_side;   // of its plane: > 0 faces the light, < 0 turns away, 0: edge-on, casts nothing
};

Caster make_caster(vec3 a, vec3 b, vec3 c, vec4 light) {
  Caster t;
  t.edges[0] = edge_plane(a, b, light);
  t.edges[1] = edge_plane(b, c, light);
  t.edges[2] = edge_plane(c, a, light);
  precise vec3 u = b - a;
  precise vec3 v = c - a;
  precise vec3 n = vec3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  t.normal = n;
  t.a = a, t.b = b, t.c = c;
  t.light_side = light.w > 0.5 ? plane_side(n, a, vec3(0.0)) : dot(n, light.xyz);
  return t;
}

// The light and the view sample lie strictly on different sides.
bool separates(float light_side, float sample_side) {
  return light_side > 0.0 ? sample_side < 0.0 : light_side < 0.0 && sample_side > 0.0;
}

bool hides(Caster t, vec3 q) {
  const float e0 = edge_side(t.edges[0], q), e1 = edge_side(t.edges[1], q), e2 = edge_side(t.edges[2], q);
  const bool inside = (e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0) || (e0 <= 0.0 && e1 <= 0.0 && e2 <= 0.0);
  return inside && separates(t.light_side, plane_side(t.normal, t.a, q));
}

// Whether it hides no point of the box. Rounding is monotonic, so the corner of the box that is farthest behind the
// plane has the extreme value of plane_side() as computed. `on_plane`: points within rounding of the plane count too.
bool hides_nothing(Caster t, vec3 lo, vec3 hi, bool on_plane) {
  const vec3 towards = t.light_side > 0.0 ? -t.normal : t.normal;
  const vec3 farthest = vec3(towards.x > 0.0 ? hi.x : lo.x, towards.y > 0.0 ? hi.y : lo.y, towards.z > 0.0 ? hi.z : lo.z);
  const float side = plane_side(t.normal, t.a, farthest), size = dot(abs(t.normal), abs(lo) + abs(hi));
  return !separates(t.light_side, side) && !(on_plane && abs(side) <= 1e-5 * size);
}
