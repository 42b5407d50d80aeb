// The half-spaces of a triangle's edges, seen from a view sample at the coordinate origin. Also compiles as C++
// (tests): include after defining vec3 and `precise`.
//
// For corners a, b relative to the view sample the plane through it and the edge has the normal a x b. A direction d
// passes the triangle's inner side of the edge when dot(a x b, d) has the sign of det(a, b, c). Unfused products make
// b x a the exact negative of a x b, so that two triangles cannot both miss a direction through their common edge.
vec3 edge_normal(vec3 a, vec3 b) {
  precise vec3 n = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return n;
}
