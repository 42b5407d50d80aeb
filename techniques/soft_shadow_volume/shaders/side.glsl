// On which side of a silhouette edge the light's pivot lies, seen from a view sample. This one sign decides both where
// a shadow volume's side is crossed and which way coverage is counted: were they to differ, a pixel on the hard shadow's
// boundary would be wrong by the whole light.
//
// Seen from P towards the light, positive when the pivot is to the left of a -> b. The products are unfused, so that
// b -> a gives the opposite number.
float side_of(vec3 p, vec3 a, vec3 b, vec3 pivot) {
  precise vec3 to_a = a - p, to_b = b - p, to_pivot = pivot - p;
  precise vec3 n = vec3(to_b.y * to_a.z - to_b.z * to_a.y, to_b.z * to_a.x - to_b.x * to_a.z,
                        to_b.x * to_a.y - to_b.y * to_a.x);
  precise float s = n.x * to_pivot.x + n.y * to_pivot.y + n.z * to_pivot.z;
  return s;
}
