// Reductions over a workgroup that is one subgroup of SG lanes (SG: a specialization constant, a power of two).
// Butterflies of shuffles and ternaries: on lavapipe they cost a sixth of subgroupMin() and its like.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require

float lower(float a, float b) { return a < b ? a : b; }
float upper(float a, float b) { return a > b ? a : b; }
vec3 lower(vec3 a, vec3 b) { return mix(b, a, lessThan(a, b)); }
vec3 upper(vec3 a, vec3 b) { return mix(b, a, greaterThan(a, b)); }
float lower(vec3 a) { return lower(lower(a.x, a.y), a.z); }
float upper(vec3 a) { return upper(upper(a.x, a.y), a.z); }

#define PENUMBRA_BUTTERFLY(type, name, combine)                                              \
  type name(type v) {                                                                        \
    if (SG > 1u) v = combine(v, subgroupShuffleXor(v, 1u));                                  \
    if (SG > 2u) v = combine(v, subgroupShuffleXor(v, 2u));                                  \
    if (SG > 4u) v = combine(v, subgroupShuffleXor(v, 4u));                                  \
    if (SG > 8u) v = combine(v, subgroupShuffleXor(v, 8u));                                  \
    if (SG > 16u) v = combine(v, subgroupShuffleXor(v, 16u));                                \
    return v;                                                                                \
  }
uint either(uint a, uint b) { return a | b; }
uint sum(uint a, uint b) { return a + b; }
PENUMBRA_BUTTERFLY(float, lowest, lower)
PENUMBRA_BUTTERFLY(float, highest, upper)
PENUMBRA_BUTTERFLY(vec3, lowest, lower)
PENUMBRA_BUTTERFLY(vec3, highest, upper)
PENUMBRA_BUTTERFLY(uint, or_of_all, either)
PENUMBRA_BUTTERFLY(uint, sum_of_all, sum)

// Bits of the lanes with `v`. On lavapipe subgroupBallot() and the votes loop over the lanes.
uint ballot(bool v) {
  if (SG > 8u) return subgroupBallot(v).x;
  return or_of_all(v ? 1u << gl_SubgroupInvocationID : 0u);
}
