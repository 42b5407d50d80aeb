// What every stage of a frame shares: constants, counts, the view samples' groups, triangles in working
// space, masks.
#pragma once
#include "gpu/buffer.h"
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/gears/light_setup.h"
#include "techniques/gears/params.h"
#include "techniques/gears/shaders/constants.h"

namespace penumbra::gears {

// Lanes of a workgroup that is one subgroup. Devices with wider subgroups leave the rest idle.
uint32_t lanes_of(const gpu::Device& device);
inline constexpr uint32_t wide_lanes = 64;  // kernels without subgroup operations
inline constexpr uint64_t groups_for(uint64_t items, uint64_t lanes) { return (items + lanes - 1) / lanes; }

struct FrameState {
  GearsParams params;
  gpu::Device* device = nullptr;
  uint32_t lanes = 8;
  MaskLayout layout;
  FrameConstants constants{};
  uint32_t width = 0, height = 0;
  float slack = 0;  // more than |P' - P|, world
  // Several triangles of a leaf matter to a group, and each covers few rows.
  bool small_triangles = true;

  gpu::Buffer frame, header, header_host;
  gpu::Buffer light_samples, weights;  // world; uploaded when the light changes
  gpu::Buffer order, triangles, list;  // slots to triangles; 3 vec4 per slot; slots for the list
  // For fetching: the frame's constants, the triangles; P', P and Ng per pixel.
  gpu::TexelView frame_texels, triangle_texels, origin_texels, position_texels, normal_texels;
  gpu::Buffer slots, resume;  // view samples of groups; groups to go on with
  gpu::Buffer walked;         // masks as walked, where not packed
  uint32_t tree_slots = 0, slot_count = 0;

  uint32_t pixels() const { return width * height; }
  // Light, layout and buffers that depend on the light alone.
  void set_light(const Case& c, gpu::PassRecorder& passes);
  // Slots of triangles; those past `tree` are for the list.
  void set_order(const std::vector<uint32_t>& slots_to_triangles, uint32_t tree, gpu::PassRecorder& passes);
  // The views for fetching. True when one is new, and has to be bound anew.
  bool set_texels(const RenderInput& in);
  // Constants up, counts and masks cleared: the first pass of a frame.
  void begin(const RenderInput& in, gpu::PassRecorder& passes);
  void prepare(gpu::Commands& commands, const gpu::ComputePipeline& pipeline,
               const GeometryOnDevice& geometry, const gpu::Buffer& boxes, uint32_t first_leaf,
               uint32_t leaf_groups);
  // Waits for the device; what it counted so far.
  Header read_header(gpu::PassRecorder& passes);
  // A walk writes visibility itself: masks have their final layout, and all light samples one weight.
  bool walk_resolves() const { return layout.packed && !layout.weighted && layout.samples % 32 == 0; }
  uint64_t masks_address(const RenderInput& in) const;
  uint64_t bytes() const;
};

// A count of two words.
inline double wide(const uint32_t (&words)[2]) { return words[0] + 4294967296.0 * words[1]; }

gpu::ComputePipeline prepare_pipeline(const FrameState& state);

}  // namespace penumbra::gears
