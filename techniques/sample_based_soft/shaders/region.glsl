// Influence regions [Sintorn2008, sec. 4.1]: what a caster may shade of a plane that is at least as far from the light
// as the view samples, seen from the light's centre. Light and casters are relative to that centre.
//
// The point v hides the light's point L from (v - L) (F - L.z) / (v.z - L.z) + L of the plane z = F. In the light's view
// and with w = 1 / F, that is u = L w + (v - L) q with q = (1 - L.z w) / (v.z - L.z): linear in w. Since the light is
// convex and holds the centre, what is hidden at a nearer plane projects into the region on a farther one.
struct LightBox {
  vec3 lo, hi;
};

// The region of a box of points, as a box in (u, v); `near`: how close to the light a point may come.
struct Region {
  vec4 rect;
  bool none;         // all of it is beyond the plane
  bool everywhere;   // it reaches into the light, so it has no end
};

Region box_region(vec3 lo, vec3 hi, LightBox light, float w, float near) {
  Region r;
  r.everywhere = !(lo.z - light.hi.z > near);
  r.none = (lo.z * w > 1.00001 && !r.everywhere) || lo.x > hi.x;
  float z0 = r.everywhere ? light.hi.z + 1.0 : lo.z;
  float z1 = hi.z * w < 1.0 ? hi.z : 1.0 / w;
  z1 = z1 > z0 ? z1 : z0;
  float q0 = (1.0 - light.lo.z * w) / (z1 - light.lo.z), q1 = (1.0 - light.hi.z * w) / (z0 - light.hi.z);
  vec2 a = light.hi.xy * w, b = light.lo.xy * w, c = lo.xy - light.hi.xy, d = hi.xy - light.lo.xy;
  vec2 least = a + min(c * q0, c * q1), most = b + max(d * q0, d * q1);
  // Rounding, of which the coordinates' own is in lo and hi.
  vec2 slack = 4e-6 * (abs(least) + abs(most) + (abs(a) + abs(b) + abs(c) + abs(d)) * (q0 + q1 + w));
  r.rect = vec4(least - slack, most + slack);
  return r;
}

bool overlap(vec4 a, vec4 b) {
  return a.x <= b.z && b.x <= a.z && a.y <= b.w && b.y <= a.w;
}

bool region_touches(Region r, vec4 rect) {
  return !r.none && (r.everywhere || overlap(r.rect, rect));
}

// Whether the region of the edge from a to b may touch the rectangle: its box, and the band along it.
bool edge_touches(vec3 a, vec3 b, LightBox light, float w, float near, float pad, vec4 rect) {
  vec3 lo = min(a, b) - pad, hi = max(a, b) + pad;
  Region r = box_region(lo, hi, light, w, near);
  if (!region_touches(r, rect) || r.everywhere) return region_touches(r, rect);
  float za = max(a.z - pad, lo.z), zb = max(b.z - pad, lo.z);
  vec2 ua = a.xy / a.z, ub = b.xy / b.z, n = vec2(ua.y - ub.y, ub.x - ua.x);
  // How far along n the light widens each end: its box times the largest q - w.
  vec2 half_ = max(abs(light.lo.xy), abs(light.hi.xy));
  float deep = max(abs(light.lo.z), abs(light.hi.z));
  float qa = max(1.0 / (za - light.hi.z) - w, 0.0), qb = max(1.0 / (zb - light.hi.z) - w, 0.0);
  vec2 wide_a = half_ * qa + abs(ua) * deep / (za - light.hi.z), wide_b = half_ * qb + abs(ub) * deep / (zb - light.hi.z);
  float slack = 1e-5 * dot(abs(n), abs(ua) + abs(ub) + wide_a + wide_b) + 4.0 * pad * (abs(n.x) + abs(n.y)) / min(za, zb);
  float most = max(dot(n, ua) + dot(abs(n), wide_a), dot(n, ub) + dot(abs(n), wide_b)) + slack;
  float least = min(dot(n, ua) - dot(abs(n), wide_a), dot(n, ub) - dot(abs(n), wide_b)) - slack;
  vec2 near_corner = mix(rect.xy, rect.zw, lessThan(n, vec2(0.0))), far_corner = mix(rect.zw, rect.xy, lessThan(n, vec2(0.0)));
  return dot(n, near_corner) <= most && dot(n, far_corner) >= least;
}
