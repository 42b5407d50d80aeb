// Push constants of the room, for GLSL and C++: addresses are 64-bit numbers in C++, references in GLSL.
#ifndef PENUMBRA_GEARS_CONSTANTS_H
#define PENUMBRA_GEARS_CONSTANTS_H
#ifdef __cplusplus
#include <cstdint>
namespace penumbra::gears {
#define PENUMBRA_UINT uint32_t
#define PENUMBRA_ADDRESS(type) uint64_t
#else
#define PENUMBRA_UINT uint
#define PENUMBRA_ADDRESS(type) type
#endif

struct PrepareConstants {
  PENUMBRA_ADDRESS(FrameRef) frame;
  PENUMBRA_ADDRESS(Floats) positions;
  PENUMBRA_ADDRESS(Uints) indices, order;    // order: triangle of each slot, or no_triangle
  PENUMBRA_ADDRESS(Vec4s) triangles, boxes;  // out: 3 per slot; 2 per leaf
  PENUMBRA_ADDRESS(Uints) list;              // out: slots outside the tree
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_UINT tree_slots, slots, first_leaf, leaf_groups;
};

struct RefitConstants {
  PENUMBRA_ADDRESS(Vec4s) boxes;  // 2 per node: lo, hi.x | hi.yz
  PENUMBRA_UINT first, count;     // nodes of this level
  PENUMBRA_UINT node_count;       // nodes past it are empty
};

struct WalkTreeConstants {
  PENUMBRA_ADDRESS(Vec4s) light_samples;  // world
  PENUMBRA_ADDRESS(Floats) visibility;    // per pixel; written where SAMPLES_SEEN
  PENUMBRA_ADDRESS(Uints) slots;          // pixel of each slot, SG per group
  PENUMBRA_ADDRESS(Uints) masks;          // WORDS per pixel
  PENUMBRA_ADDRESS(Uints) list;           // slots outside the tree
  PENUMBRA_ADDRESS(Uints)
  resume;  // two lists of what to go on with, `capacity` each: group, lanes, next leaf
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_UINT groups, work_groups, first_leaf;
  PENUMBRA_UINT list_begin, list_end;  // part of the list for this dispatch
  PENUMBRA_UINT read_list;             // which of the two resume lists is read; the other is written
  PENUMBRA_UINT capacity;              // at least `groups`
  PENUMBRA_UINT split_turns;           // loop turns after which a group goes on in another dispatch
  PENUMBRA_UINT groups_each;           // groups that a workgroup does one after the other; 1 for what goes on
  PENUMBRA_UINT parts;                 // 2: each entry of the resume list goes on as two
};

struct WalkCellsConstants {
  PENUMBRA_ADDRESS(Vec4s) light_samples;  // world
  PENUMBRA_ADDRESS(Floats) visibility;    // per pixel; written where SAMPLES_SEEN
  PENUMBRA_ADDRESS(Uints) slots, masks;
  PENUMBRA_ADDRESS(Uints) list;         // triangles outside the cells
  PENUMBRA_ADDRESS(Uints) group_cells;  // cell of each group
  PENUMBRA_ADDRESS(Uints)
  counts, offsets;  // per cell: its triangles, and where its list would begin in one list of all cells
  PENUMBRA_ADDRESS(Uints) assigned;  // the lists of this chunk of cells
  PENUMBRA_ADDRESS(Uints) resume;    // two lists of groups to go on with, then per group the triangles done
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_UINT groups, first_group, work_groups;
  PENUMBRA_UINT chunk_begin;  // offset of the chunk's first list
  PENUMBRA_UINT list_begin, list_end;
  PENUMBRA_UINT read_list;
};

struct FitGridConstants {
  PENUMBRA_ADDRESS(Uints) histogram;  // BINS for x, BINS for y; 0 before
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_UINT width, height, step;  // every step-th pixel of every step-th row
  PENUMBRA_UINT grid_size;
  float slack;
};

struct BinSamplesConstants {
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Uints) counts;        // per cell, 0 before either stage
  PENUMBRA_ADDRESS(Uints) first_groups;  // per cell: its first group
  PENUMBRA_ADDRESS(Uints)
  slots, group_cells;  // out: SG slots per group, no_sample before; cell of each group
  PENUMBRA_UINT pixels, grid_size;
  float slack;
};

struct BinTrianglesConstants {
  PENUMBRA_ADDRESS(FrameRef) frame;
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Vec4s) triangles;  // 3 per slot, working space
  PENUMBRA_ADDRESS(Uints) counts;     // per cell, 0 before either stage
  PENUMBRA_ADDRESS(Uints) offsets;    // per cell: where its list would begin in one list of all cells
  PENUMBRA_ADDRESS(Uints) assigned;   // out: lists of the chunk, chunk_begin being its first offset
  PENUMBRA_ADDRESS(Uints) large;      // slots of large triangles
  PENUMBRA_UINT slots, grid_size, large_count;
  PENUMBRA_UINT cell_begin, cell_end, chunk_begin;
};

#undef PENUMBRA_UINT
#undef PENUMBRA_ADDRESS
#ifdef __cplusplus
static_assert(sizeof(PrepareConstants) <= 128 && sizeof(PrepareConstants) % 8 == 0);
static_assert(sizeof(RefitConstants) <= 128 && sizeof(RefitConstants) % 8 == 0);
static_assert(sizeof(WalkTreeConstants) <= 128 && sizeof(WalkTreeConstants) % 8 == 0);
static_assert(sizeof(WalkCellsConstants) <= 128 && sizeof(WalkCellsConstants) % 8 == 0);
static_assert(sizeof(FitGridConstants) <= 128 && sizeof(FitGridConstants) % 8 == 0);
static_assert(sizeof(BinSamplesConstants) <= 128 && sizeof(BinSamplesConstants) % 8 == 0);
static_assert(sizeof(BinTrianglesConstants) <= 128 && sizeof(BinTrianglesConstants) % 8 == 0);
}  // namespace
#endif
#endif
