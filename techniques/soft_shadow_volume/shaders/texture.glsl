// Grey textures: the light's radiance is constant over each texel, so areas become integrals of a function that is
// constant over cells. With F(x, y) the integral along the row up to x, the integral over a polygon is that of F dy
// around its border. Deviation: the original looks it up in a table of four dimensions.
//
// `weights`: parts of a split light below each other, `texture_rows` rows each from `first_row` on. A texel holds F at
// its left border, its weight, and the integral of F up to that border.
// `first_row` and `texture_rows` are globals that the including shader sets.
int first_row, texture_rows;

vec4 cell(int column, int row) { return texelFetch(weights, ivec2(column, first_row + row), 0); }

// The integral of F over x in [a, b], divided by b - a.
float mean_along(int row, float a, float b) {
  const int columns = textureSize(weights, 0).x;
  const float width = 2.0 / float(columns);
  const int i = clamp(int((a + 1.0) / width), 0, columns - 1), k = clamp(int((b + 1.0) / width), 0, columns - 1);
  const vec4 ci = cell(i, row), ck = cell(k, row);
  const float ta = a + 1.0 - width * float(i), tb = b + 1.0 - width * float(k);
  const float fa = ci.x + ci.y * ta, fb = ck.x + ck.y * tb;
  const float border = max(i, k) > min(i, k) ? width * float(max(i, k)) - 1.0 : a;
  const float at_border = i < k ? ck.x : ci.x;
  // Within a texel, or across one border, as trapezoids: differences of large integrals would cancel.
  const float near = 0.5 * ((fa + at_border) * (border - a) + (at_border + fb) * (b - border));
  const float far = ck.z + (ck.x + 0.5 * ck.y * tb) * tb - ci.z - (ci.x + 0.5 * ci.y * ta) * ta;
  const float d = b - a;
  return i == k || abs(d) < 1e-12 ? 0.5 * (fa + fb) : (abs(i - k) == 1 ? near : far) / d;
}

// The integral of F dy from p to q, both on the light.
float along(vec2 p, vec2 q) {
  const bool up = q.y >= p.y;
  const vec2 from = up ? p : q, to = up ? q : p;
  const float rows = float(texture_rows), slope = to.y > from.y ? (to.x - from.x) / (to.y - from.y) : 0.0;
  const int first = clamp(int((from.y + 1.0) * 0.5 * rows), 0, texture_rows - 1);
  const int last = clamp(int((to.y + 1.0) * 0.5 * rows), 0, texture_rows - 1);
  float sum = 0.0;
  for (int row = first; row <= last; ++row) {
    const float lo = row == first ? from.y : 2.0 * float(row) / rows - 1.0;
    const float hi = row == last ? to.y : 2.0 * float(row + 1) / rows - 1.0;
    const float a = clamp(from.x + slope * (lo - from.y), -1.0, 1.0);
    const float b = clamp(from.x + slope * (hi - from.y), -1.0, 1.0);
    sum += hi > lo ? (hi - lo) * mean_along(row, a, b) : 0.0;
  }
  return up ? sum : -sum;
}

// A point of the horizon's line on the light, if the line cuts it.
vec2 on_horizon(View v) {
  const vec2 d = vec2(-v.horizon.y, v.horizon.x);
  const vec2 foot = -v.horizon.z * v.horizon.xy / max(dot(d, d), 1e-30);
  float t0 = -1e30, t1 = 1e30;
  for (int k = 0; k < 2; ++k) {
    if (abs(d[k]) < 1e-20) continue;
    const float a = (-1.0 - foot[k]) / d[k], b = (1.0 - foot[k]) / d[k];
    t0 = max(t0, min(a, b));
    t1 = min(t1, max(a, b));
  }
  return clamp(foot + 0.5 * (t0 + t1) * d, -1.0, 1.0);
}

// What p -> q adds to the integral over the part above the horizon of a polygon whose border it is on. Where the border
// crosses the horizon the polygon is closed along it, by way of `base`.
float border_part(View v, vec2 base, vec2 p, vec2 q) {
  if (!HORIZON) return along(p, q);
  const float hp = height(v, p), hq = height(v, q);
  if (max(hp, hq) <= 0.0) return 0.0;
  const vec2 x = p + hp / (hp - hq) * (q - p);
  if (min(hp, hq) >= 0.0) return along(p, q);
  return hp > 0.0 ? along(p, x) - along(base, x) : along(base, x) + along(x, q);
}

// Along the light's border from its corner (1, -1), counter-clockwise, to `place`.
float border_integral(View v, vec2 base, float place) {
  float sum = 0.0;
  for (int side = 0; side < 4; ++side) {
    const float way = clamp(place - 2.0 * float(side), 0.0, 2.0);
    const vec2 from = corner(side), to = mix(from, corner((side + 1) & 3), 0.5 * way);
    if (way > 0.0) sum += border_part(v, base, from, to);
  }
  return sum;
}

// The light above the horizon, of 4 times its mean.
float textured_above(View v) { return border_integral(v, on_horizon(v), 8.0); }

vec2 on_border(vec2 x) { return x / max(max(abs(x.x), abs(x.y)), 1e-30); }

// The triangle (centre, a, b) less the sector from a to b: around what lies between the edge and the border.
float textured_beyond(View v, vec2 a, vec2 b, bool left) {
  const vec2 base = on_horizon(v), a_out = on_border(a), b_out = on_border(b);
  const float from = border_place(a), to = border_place(b), all = border_integral(v, base, 8.0);
  const float border = border_integral(v, base, to) - border_integral(v, base, from) + turns(from, to, 8.0, left) / 8.0 * all;
  return border_part(v, base, a, b) + border_part(v, base, b, b_out) - border + border_part(v, base, a_out, a);
}
