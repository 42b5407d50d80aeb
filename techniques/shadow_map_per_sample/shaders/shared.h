// Structs that GLSL and C++ share.
#ifndef PENUMBRA_SHADOW_MAP_PER_SAMPLE_SHARED_H
#define PENUMBRA_SHADOW_MAP_PER_SAMPLE_SHARED_H
#ifdef __cplusplus
#include <cstdint>
#define ADDRESS_OF(type) uint64_t
namespace penumbra::shadow_map_per_sample {
using uint = uint32_t;
#else
#define ADDRESS_OF(type) type
#endif

struct AccumulatePush {
  ADDRESS_OF(FloatArray) lit;         // what this light sample's map says
  ADDRESS_OF(FloatArray) visibility;  // weighted sum over the light samples so far
  ADDRESS_OF(UintArray) mask;
  uint pixels;
  uint light_sample;
  uint mask_words;  // per pixel
  float weight;
};

#ifdef __cplusplus
static_assert(sizeof(AccumulatePush) == 40);
}  // namespace penumbra::shadow_map_per_sample
#endif
#endif
