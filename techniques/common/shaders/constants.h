// Push constants of the shared kernels, for GLSL and C++: addresses are 64-bit numbers in C++, references in
// GLSL.
#ifndef PENUMBRA_COMMON_CONSTANTS_H
#define PENUMBRA_COMMON_CONSTANTS_H
#ifdef __cplusplus
#include <cstdint>
namespace penumbra {
#define PENUMBRA_UINT uint32_t
#define PENUMBRA_ADDRESS(type) uint64_t
#else
#define PENUMBRA_UINT uint
#define PENUMBRA_ADDRESS(type) type
#endif

struct SampleGroupsConstants {
  PENUMBRA_ADDRESS(Uints) slots;        // out: pixel of each slot, SG slots per group
  PENUMBRA_ADDRESS(Uints) group_count;  // out: one counter, 0 before
  PENUMBRA_ADDRESS(Uints) group_lists;  // in lists: list of each group; of each list its first group, length
  PENUMBRA_ADDRESS(Uints) first_groups, lengths;
  PENUMBRA_UINT width, height, tiles_x, tiles;
  float slack;         // world: more than |P' - P|
  float depth_weight;  // of the distance to the light against the directions across
};

struct PrefixScanConstants {
  PENUMBRA_ADDRESS(Uints) values, sums;  // in; out, one per value
  PENUMBRA_ADDRESS(Uints) blocks;        // total (2 words), then 2 words per block
  PENUMBRA_UINT count, block_count;
  PENUMBRA_UINT per_lane;  // consecutive values of a lane; a block is a subgroup's
};

struct MaskResolveConstants {
  PENUMBRA_ADDRESS(Uints) walked, masks;  // the same where PACKED
  PENUMBRA_ADDRESS(Floats) visibility, weights;
  PENUMBRA_ADDRESS(Uints) places;  // per light sample: its bit in the walked mask, where it is clustered
  PENUMBRA_UINT pixels, mask_words;
};

struct SampleMeanConstants {
  PENUMBRA_ADDRESS(Floats) lit;         // what is seen of this light sample, per pixel
  PENUMBRA_ADDRESS(Floats) visibility;  // weighted sum over the light samples so far
  PENUMBRA_ADDRESS(Uints) masks;
  PENUMBRA_UINT pixels, light_sample, mask_words;
  float weight;
};

#undef PENUMBRA_UINT
#undef PENUMBRA_ADDRESS
#ifdef __cplusplus
static_assert(sizeof(SampleGroupsConstants) <= 128 && sizeof(SampleGroupsConstants) % 8 == 0);
static_assert(sizeof(PrefixScanConstants) <= 128);
static_assert(sizeof(MaskResolveConstants) <= 128 && sizeof(MaskResolveConstants) % 8 == 0);
static_assert(sizeof(SampleMeanConstants) == 40);
}  // namespace
#endif
#endif
