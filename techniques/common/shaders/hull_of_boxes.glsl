// Whether a box may hide a light sample of a box from a view sample of another: the hull of the group's box and the
// light's is the union of the boxes between them, box(t) = group + grow t for t in [0, t_end]; a box that meets it meets
// box(t) in all axes for one t: six linear conditions on t. Include after group_lo, group_hi and pad.
vec3 grow_lo, grow_hi;      // from the group's box to the light's, per unit of t

bool meets_hull(vec3 lo, vec3 hi, float t_end) {
  float t0 = 0.0, t1 = t_end;
  vec3 need_hi = lo - group_hi - pad, need_lo = hi - group_lo + pad;   // grow_hi t >= need_hi, grow_lo t <= need_lo
  [[unroll]] for (int k = 0; k < 3; k++) {
    float g = grow_hi[k], r = need_hi[k] / (abs(g) < 1e-30 ? 1e-30 : g);
    t0 = upper(t0, g >= -1e-30 ? r : t0);
    t1 = lower(t1, g < -1e-30 ? r : t1);
    g = grow_lo[k];
    r = need_lo[k] / (abs(g) < 1e-30 ? 1e-30 : g);
    t1 = lower(t1, g >= -1e-30 ? r : t1);
    t0 = upper(t0, g < -1e-30 ? r : t0);
  }
  return t0 <= t1 + 1e-5 * (1.0 + abs(t1));
}
