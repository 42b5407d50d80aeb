// The exact test of a triangle against a view sample.
//
// A triangle hides a view sample p when p lies on the other side of the triangle's plane than the light, and on the
// inner side of the three planes through the light and an edge.
//
// Corners are taken relative to the view sample: the difference of near points is exact, so that what is decided about
// a view sample and its own neighbourhood does not depend on how far the light or the middle of the scene is.
//
// Watertight: the side of an edge is one expression, odd in the order of its ends, so that two triangles that share an
// edge see values of exactly opposite sign; zero counts as inside for both. `precise` keeps the compiler from fusing
// products in one of them only.

// Of the direction d, passing the edge a-b: twice dot(cross(a, b), d). The sum and the difference of the ends enter the
// product, not both ends: its rounding error then scales with the edge and not with the distance.
float edge_side(vec3 a, vec3 b, vec3 d) {
  precise vec3 sum = a + b;
  precise vec3 along = b - a;
  precise vec3 n = vec3(sum.y * along.z - sum.z * along.y, sum.z * along.x - sum.x * along.z,
                        sum.x * along.y - sum.y * along.x);
  precise float e = n.x * d.x + n.y * d.y + n.z * d.z;
  return e;
}

float plane_side(vec3 normal, vec3 corner, vec3 p) {
  precise float s = normal.x * (p.x - corner.x) + normal.y * (p.y - corner.y) + normal.z * (p.z - corner.z);
  return s;
}

struct Caster {
  vec3 a, b, c, normal;
  float light_side;   // of its plane: > 0 faces the light, < 0 turns away, 0: edge-on, casts nothing
};

// `light`: position, 1; or the direction towards a light at infinity, 0.
Caster make_caster(vec3 a, vec3 b, vec3 c, vec4 light) {
  precise vec3 u = b - a;
  precise vec3 v = c - a;
  precise vec3 n = vec3(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  Caster t;
  t.a = a, t.b = b, t.c = c;
  t.normal = n;
  t.light_side = light.w > 0.5 ? plane_side(n, a, light.xyz) : dot(n, light.xyz);
  return t;
}

// The light and the view sample lie strictly on different sides.
bool separates(float light_side, float sample_side) {
  return light_side > 0.0 ? sample_side < 0.0 : light_side < 0.0 && sample_side > 0.0;
}

bool hides(Caster t, vec3 p, vec4 light) {
  precise vec3 a = t.a - p;
  precise vec3 b = t.b - p;
  precise vec3 c = t.c - p;
  precise vec3 towards = light.xyz - p * light.w;
  const float e0 = edge_side(a, b, towards), e1 = edge_side(b, c, towards), e2 = edge_side(c, a, towards);
  const bool inside = (e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0) || (e0 <= 0.0 && e1 <= 0.0 && e2 <= 0.0);
  return inside && separates(t.light_side, plane_side(t.normal, t.a, p));
}

// Whether it hides no point of the box. Rounding is monotonic, so the corner of the box that is farthest behind the
// plane has the extreme value of plane_side() as computed.
bool hides_nothing(Caster t, vec3 lo, vec3 hi) {
  const vec3 towards = t.light_side > 0.0 ? -t.normal : t.normal;
  const vec3 farthest = vec3(towards.x > 0.0 ? hi.x : lo.x, towards.y > 0.0 ? hi.y : lo.y, towards.z > 0.0 ? hi.z : lo.z);
  return !separates(t.light_side, plane_side(t.normal, t.a, farthest));
}
