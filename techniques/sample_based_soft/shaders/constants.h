// Push constants of the room, for GLSL and C++: addresses are 64-bit numbers in C++, references in GLSL.
#ifndef PENUMBRA_SAMPLE_BASED_SOFT_CONSTANTS_H
#define PENUMBRA_SAMPLE_BASED_SOFT_CONSTANTS_H
#ifdef __cplusplus
#include <cstdint>
namespace penumbra::sample_based_soft {
#define PENUMBRA_UINT uint32_t
#define PENUMBRA_ADDRESS(type) uint64_t
#else
#define PENUMBRA_UINT uint
#define PENUMBRA_ADDRESS(type) type
#endif

const PENUMBRA_UINT pixels_per_lane = 16;  // of the pass that projects the view samples

struct SamplesConstants {  // project.comp, bin_samples.comp, measure_lists.comp
  PENUMBRA_ADDRESS(FrameRef) frame;
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Vec4s) origin, normal;  // per pixel: P' (w = 0: no view sample), Ng
  PENUMBRA_ADDRESS(Vec4s) places;          // per pixel: u, v, z; w = 1: in the frustum, 2: outside, 0: unlit
  PENUMBRA_ADDRESS(Uints) bins;            // per pixel: its bin, or no_sample, and its place there
  PENUMBRA_ADDRESS(Uints) counts;          // per bin: view samples
  PENUMBRA_ADDRESS(Uints) begins;          // per bin: view samples of the bins before it
  PENUMBRA_ADDRESS(Uints) farthest;        // per list, then per tile: float bits of the largest z, 0: empty
  PENUMBRA_ADDRESS(Uints) lengths;         // per list
  PENUMBRA_ADDRESS(Uints) first_groups;    // per list
  PENUMBRA_ADDRESS(Uints) slots;           // SG per group: pixels; no_sample before
  PENUMBRA_ADDRESS(Uints) group_lists;     // per group: its list
  PENUMBRA_UINT pixels, grid_size, slices;
  float slack;  // world: more than |P' - P|
};

struct CastersConstants {  // face_light.comp, prepare_casters.comp
  PENUMBRA_ADDRESS(FrameRef) frame;
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Floats) positions;
  PENUMBRA_ADDRESS(Uints) indices, order;  // order: triangle of each slot, or no_triangle
  PENUMBRA_ADDRESS(Uints) closed;          // a bit per triangle
  PENUMBRA_ADDRESS(Uints) facing;          // per triangle: which side of it the light sees
  PENUMBRA_ADDRESS(Uints) neighbours;      // per triangle, 3: the triangle across the edge, or no_triangle
  PENUMBRA_ADDRESS(Vec4s) triangles;       // out: 3 per slot
  PENUMBRA_ADDRESS(Vec4s) regions;         // out: 2 per caster: the box of what it is made of
  PENUMBRA_ADDRESS(Vec4s) edges;           // out: 2 per caster: the box of its potential silhouette edges
  PENUMBRA_ADDRESS(Vec4s) hulls;           // out: HULL_TEXELS per caster: its influence region's outline
  PENUMBRA_ADDRESS(Uints) list;            // out: slots outside the blocks
  PENUMBRA_UINT triangle_count, block_slots, slots, unused;
};

struct CoverConstants {  // cover.comp
  PENUMBRA_ADDRESS(FrameRef) frame;
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Uints) farthest;       // of the lists, or of the tiles
  PENUMBRA_ADDRESS(Uints) parent_begins;  // casters of tile t: parents [begins[t], begins[t] + counts[t])
  PENUMBRA_ADDRESS(Uints) parent_counts;
  PENUMBRA_ADDRESS(Uints) parents;
  PENUMBRA_ADDRESS(Uints) counts;           // in and out: casters so far
  PENUMBRA_ADDRESS(Uints) begins, casters;  // out: casters from begins[list] - chunk_begin on
  PENUMBRA_ADDRESS(Uints) penumbrae;        // out: 1 for lists that a silhouette edge's region touches
  PENUMBRA_ADDRESS(Uints) listed;           // slots outside the blocks
  PENUMBRA_UINT first_list, lists;          // of this dispatch
  PENUMBRA_UINT first_parent, last_parent;  // part of each parent's casters that is tested
  PENUMBRA_UINT grid_size, chunk_begin, caster_count, list_count;
};

struct SplitConstants {  // split_groups.comp
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_ADDRESS(Uints) group_lists, penumbrae;
  PENUMBRA_ADDRESS(Uints) work;  // out: groups in a penumbra, from 0 on; the others, from `capacity` on
  PENUMBRA_UINT first_group, groups, capacity, unused;
};

struct WalkConstants {                  // walk.comp
  PENUMBRA_ADDRESS(Floats) visibility;  // per pixel; written where SAMPLES_SEEN
  PENUMBRA_ADDRESS(Uints) slots, masks;
  PENUMBRA_ADDRESS(Uints) list;            // slots outside the blocks
  PENUMBRA_ADDRESS(Uints) group_lists;     // list of view samples of each group
  PENUMBRA_ADDRESS(Uints) counts, begins;  // per list: its casters
  PENUMBRA_ADDRESS(Uints) casters;
  PENUMBRA_ADDRESS(Uints) work;    // groups to do, where WORK
  PENUMBRA_ADDRESS(Uints) resume;  // two lists of groups to go on with, then per group the casters done
  PENUMBRA_ADDRESS(HeaderRef) header;
  PENUMBRA_UINT first_group, work_groups, capacity;
  PENUMBRA_UINT chunk_begin;
  PENUMBRA_UINT list_begin, list_end;
  PENUMBRA_UINT read_list;
  PENUMBRA_UINT first_word;  // of the masks, for this pass
  PENUMBRA_UINT caster_count;
  PENUMBRA_UINT outside_list;  // of view samples outside the frustum: all casters are its own
};

struct TableConstants {             // build_table.comp
  PENUMBRA_ADDRESS(Vec4s) samples;  // working space
  PENUMBRA_ADDRESS(Uints) table;    // out: `words` per entry
  PENUMBRA_UINT sample_count, words, first_entry, entries;
  PENUMBRA_UINT size;  // entries along each of the three axes
  float radius;
};

struct ShadeConstants {                              // bend_normals.comp, shade_coherently.comp
  PENUMBRA_ADDRESS(Floats) positions, barycentrics;  // barycentrics: 2 per pixel
  PENUMBRA_ADDRESS(Uints) indices, triangle;         // triangle: per pixel
  PENUMBRA_ADDRESS(Uints)
  first_faces, faces, corner;  // corners (places in indices) at each welded vertex; a vertex's welded one
  PENUMBRA_ADDRESS(Vec4s) position, normal, shading_normal;
  PENUMBRA_ADDRESS(Floats) bent;     // per welded vertex: least and largest dot(l, face normal)
  PENUMBRA_ADDRESS(Floats) cosines;  // out: per pixel
  float light[3];                    // the light's centre, world
  float weight;                      // c
  PENUMBRA_UINT count, unused;       // of welded vertices, or pixels
};

#undef PENUMBRA_UINT
#undef PENUMBRA_ADDRESS
#ifdef __cplusplus
static_assert(sizeof(SamplesConstants) <= 128 && sizeof(SamplesConstants) % 8 == 0);
static_assert(sizeof(CastersConstants) <= 128 && sizeof(CastersConstants) % 8 == 0);
static_assert(sizeof(CoverConstants) <= 128 && sizeof(CoverConstants) % 8 == 0);
static_assert(sizeof(SplitConstants) <= 128 && sizeof(SplitConstants) % 8 == 0);
static_assert(sizeof(WalkConstants) <= 128 && sizeof(WalkConstants) % 8 == 0);
static_assert(sizeof(ShadeConstants) <= 128 && sizeof(ShadeConstants) % 8 == 0);
static_assert(sizeof(TableConstants) <= 128 && sizeof(TableConstants) % 8 == 0);
}  // namespace
#endif
#endif
