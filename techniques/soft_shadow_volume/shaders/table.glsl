// The slides' tables in place of arithmetic: angles of two points about the light's centre, then by both angles the
// area of the light between the two rays. Linear between entries.

float entry(sampler2D table, ivec2 at) { return texelFetch(table, at, 0).x; }

// The slides: "a cube map that implements atan2". One octant of it; the others follow by symmetry.
float angle_by_table(vec2 x) {
  const vec2 a = abs(x);
  const int last = textureSize(angles, 0).x - 1;
  const float at = min(a.x, a.y) / max(max(a.x, a.y), 1e-30) * float(last);
  const int i = min(int(at), last - 1);
  float angle = mix(entry(angles, ivec2(i, 0)), entry(angles, ivec2(i + 1, 0)), at - float(i));
  if (a.y > a.x) angle = 0.5 * pi - angle;
  if (x.x < 0.0) angle = pi - angle;
  return x.y < 0.0 ? -angle : angle;
}

// The table's two axes run from -pi to pi; it holds the area swept from the first angle to the second without
// passing through pi, so that it has no step.
float sector_by_table(vec2 a, vec2 b, bool left) {
  const float from = angle_by_table(a), to = angle_by_table(b);
  const int last = textureSize(areas, 0).x - 1;
  const vec2 at = clamp((vec2(from, to) + pi) / (2.0 * pi), 0.0, 1.0) * float(last);
  const ivec2 i = min(ivec2(at), ivec2(last - 1));
  const vec2 f = at - vec2(i);
  const float swept = mix(mix(entry(areas, i), entry(areas, i + ivec2(1, 0)), f.x),
                          mix(entry(areas, i + ivec2(0, 1)), entry(areas, i + ivec2(1, 1)), f.x), f.y);
  return swept + turns(from, to, 2.0 * pi, left) / (2.0 * pi) * (disc ? pi : 4.0);
}
