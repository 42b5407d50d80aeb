// Whether a triangle and a subnode overlap: the separating-axis test [AkenineMoller2001]. Also compiles as C++
// (include after glsl.h): additions and products alone, unfused, so that host and device agree to the bit.
//
// All in leaves. The subnode's half size comes padded by more than rounding can displace a separating plane, so
// the answer errs towards overlap only. A triangle's own normal is unreliable where it is a sliver; its test has an
// error bound of its own.

struct Corners {
  vec3 a, b, c;
};

// Leaves from world.
vec3 to_leaves(vec3 p, vec3 lo, vec3 scale) {
  precise vec3 q = VEC3((p.x - lo.x) * scale.x, (p.y - lo.y) * scale.y, (p.z - lo.z) * scale.z);
  return q;
}

float least(float a, float b, float c) { return min(a, min(b, c)); }
float most(float a, float b, float c) { return max(a, max(b, c)); }

// Axis e x u_axis in the plane of the two other axes: (eu, ev) is the edge there, p and q two corners.
bool apart_across(float eu, float ev, float pu, float pv, float qu, float qv, float hu, float hv) {
  precise float p = ev * pu - eu * pv;
  precise float q = ev * qu - eu * qv;
  precise float r = abs(ev) * hu + abs(eu) * hv;
  return min(p, q) > r || max(p, q) < -r;
}

// `on` is a corner of the edge e, `off` the corner that is not.
bool edge_separates(vec3 e, vec3 on, vec3 off, vec3 h) {
  return apart_across(e.y, e.z, on.y, on.z, off.y, off.z, h.y, h.z) ||
         apart_across(e.z, e.x, on.z, on.x, off.z, off.x, h.z, h.x) ||
         apart_across(e.x, e.y, on.x, on.y, off.x, off.y, h.x, h.y);
}

bool plane_separates(vec3 e, vec3 f, vec3 a, vec3 h) {
  precise vec3 n = VEC3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x);
  precise float d = n.x * a.x + n.y * a.y + n.z * a.z;
  precise float r = abs(n.x) * h.x + abs(n.y) * h.y + abs(n.z) * h.z;
  float es = most(abs(e.x), abs(e.y), abs(e.z)), fs = most(abs(f.x), abs(f.y), abs(f.z));
  precise float error = 2e-6f * es * fs * (most(abs(a.x), abs(a.y), abs(a.z)) + most(h.x, h.y, h.z));
  return abs(d) > r + error;
}

bool overlaps(Corners t, vec3 center, vec3 h) {
  precise vec3 a = VEC3(t.a.x - center.x, t.a.y - center.y, t.a.z - center.z);
  precise vec3 b = VEC3(t.b.x - center.x, t.b.y - center.y, t.b.z - center.z);
  precise vec3 c = VEC3(t.c.x - center.x, t.c.y - center.y, t.c.z - center.z);
  if (least(a.x, b.x, c.x) > h.x || most(a.x, b.x, c.x) < -h.x || least(a.y, b.y, c.y) > h.y ||
      most(a.y, b.y, c.y) < -h.y || least(a.z, b.z, c.z) > h.z || most(a.z, b.z, c.z) < -h.z)
    return false;
  precise vec3 e = VEC3(t.b.x - t.a.x, t.b.y - t.a.y, t.b.z - t.a.z);
  precise vec3 f = VEC3(t.c.x - t.b.x, t.c.y - t.b.y, t.c.z - t.b.z);
  precise vec3 g = VEC3(t.a.x - t.c.x, t.a.y - t.c.y, t.a.z - t.c.z);
  return !plane_separates(e, f, a, h) && !edge_separates(e, a, c, h) && !edge_separates(f, b, a, h) &&
         !edge_separates(g, c, b, h);
}

// First and last subnode along one axis that a triangle with corners p, q, r may overlap, of `n` subnodes of `subnode`
// leaves from `lo` on.
uint first_subnode(float p, float q, float r, float padding, float lo, float subnode, uint n) {
  precise float at = (least(p, q, r) - padding - lo) / subnode;
  return uint(clamp(floor(at - 0.001f), 0.0f, float(n - 1u)));
}
uint last_subnode(float p, float q, float r, float padding, float lo, float subnode, uint n) {
  precise float at = (most(p, q, r) + padding - lo) / subnode;
  return uint(clamp(floor(at + 0.001f), 0.0f, float(n - 1u)));
}
