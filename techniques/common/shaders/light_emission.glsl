// Whether a light, seen as one point or direction, shines on the side of a surface that the viewer sees: above its
// horizon, in a spot's cone, in front of a rectangle. `towards`, `emission`: light_emission.h.
bool may_be_lit(vec3 point, vec3 normal, vec4 towards, vec4 emission) {
  const vec3 to_light = towards.xyz - towards.w * point;
  return dot(normal, to_light) > 0 &&
         (emission.w <= -1 || dot(emission.xyz, -to_light) >= emission.w * length(to_light));
}
