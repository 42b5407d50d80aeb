#include "techniques/gears/frame_state.h"

#include <algorithm>
#include <bit>

#include "shaders/gears_prepare_triangles.h"

namespace penumbra::gears {

namespace {

constexpr std::size_t few_triangles = 16384;

}  // namespace

uint32_t lanes_of(const gpu::Device& device) { return std::min(device.caps().subgroup_size, 32u); }

void FrameState::set_light(const Case& c, gpu::PassRecorder& passes) {
  device = c.device;
  lanes = lanes_of(*device);
  width = static_cast<uint32_t>(c.width);
  height = static_cast<uint32_t>(c.height);
  const LightSamples& samples = *c.light_samples;
  const Box& bounds = c.frame->geometry.bounds;
  layout = mask_layout(c.frame->light, samples);
  constants = frame_constants(c.frame->light, samples, layout, bounds, params.extrusion_length);
  slack = 2 * relative_offset * bounds.diagonal();
  small_triangles = c.frame->geometry.triangle_count() > few_triangles;
  const std::size_t bytes = samples.points.size() * sizeof(Vec4f);
  gpu::ensure(light_samples, *device, bytes, gpu::Memory::device, "the light samples");
  gpu::upload(passes, "upload_light", light_samples, samples.points.data(), bytes);
  if (layout.weighted) {
    gpu::ensure(weights, *device, samples.weights.size() * 4, gpu::Memory::device,
                "the light samples' weights");
    gpu::upload(passes, "upload_light", weights, samples.weights.data(), samples.weights.size() * 4);
  }
  gpu::ensure(frame, *device, sizeof(FrameConstants), gpu::Memory::device, "the frame's constants");
  gpu::ensure(header, *device, sizeof(Header), gpu::Memory::device, "counts");
  gpu::ensure(header_host, *device, sizeof(Header), gpu::Memory::read_back, "counts");
  if (!layout.packed)
    gpu::ensure(walked, *device, std::size_t{pixels()} * static_cast<std::size_t>(layout.words) * 4,
                gpu::Memory::device, "the masks as walked");
}

void FrameState::set_order(const std::vector<uint32_t>& slots_to_triangles, uint32_t tree,
                           gpu::PassRecorder& passes) {
  tree_slots = tree;
  slot_count = static_cast<uint32_t>(slots_to_triangles.size());
  const std::size_t bytes = slots_to_triangles.size() * 4;
  gpu::ensure(order, *device, bytes, gpu::Memory::device, "the order of the triangles");
  gpu::ensure(list, *device, bytes, gpu::Memory::device, "the list of triangles outside the tree");
  gpu::ensure(triangles, *device, slots_to_triangles.size() * 3 * sizeof(Vec4f), gpu::Memory::device,
              "triangles in working space");
  gpu::upload(passes, "upload_order", order, slots_to_triangles.data(), bytes);
}

uint64_t FrameState::masks_address(const RenderInput& in) const {
  return layout.packed ? in.device.mask->address() : walked.address();
}

bool FrameState::set_texels(const RenderInput& in) {
  bool fresh = frame_texels.set(*device, frame, "the frame's constants");
  fresh |= triangle_texels.set(*device, triangles, "triangles in working space");
  const ViewSamples& view = *in.view_samples;
  fresh |= origin_texels.set(*device, view.origin(), "view samples");
  fresh |= position_texels.set(*device, view.position(), "view samples");
  return normal_texels.set(*device, view.geometric_normal(), "view samples") || fresh;
}

void FrameState::begin(const RenderInput& in, gpu::PassRecorder& passes) {
  passes.device_pass("begin", [&](gpu::Commands& commands) {
    commands.update(frame, &constants, sizeof constants);
    commands.fill(header, 0);
    const gpu::Buffer& masks = layout.packed ? *in.device.mask : walked;
    // Pixels that no light sample reaches belong to no group: all is blocked.
    commands.fill(masks, 0xffffffffu, 0, uint64_t{pixels()} * static_cast<uint64_t>(layout.words) * 4);
    if (walk_resolves()) commands.fill(*in.device.visibility, 0, 0, uint64_t{pixels()} * 4);
    commands.barrier();
  });
}

gpu::ComputePipeline prepare_pipeline(const FrameState& state) {
  const gpu::Specialization constants[] = {{0, state.lanes}, {1, state.layout.grid}};
  return gpu::ComputePipeline(*state.device, gears_prepare_triangles_spv, sizeof(PrepareConstants),
                              constants);
}

void FrameState::prepare(gpu::Commands& commands, const gpu::ComputePipeline& pipeline,
                         const GeometryOnDevice& geometry, const gpu::Buffer& boxes, uint32_t first_leaf,
                         uint32_t leaf_groups) {
  PrepareConstants pc{};
  pc.frame = frame.address();
  pc.positions = geometry.positions.address();
  pc.indices = geometry.indices.address();
  pc.order = order.address();
  pc.triangles = triangles.address();
  pc.boxes = boxes.address();
  pc.list = list.address();
  pc.header = header.address();
  pc.tree_slots = tree_slots;
  pc.slots = slot_count;
  pc.first_leaf = first_leaf;
  pc.leaf_groups = leaf_groups;
  commands.dispatch(pipeline, pc, groups_for(slot_count, lanes));
  commands.barrier();
}

Header FrameState::read_header(gpu::PassRecorder& passes) {
  passes.device_pass("read_counts",
                     [&](gpu::Commands& commands) { commands.copy(header, header_host, sizeof(Header)); });
  passes.finish();
  return header_host.view<Header>()[0];
}

uint64_t FrameState::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&frame, &header, &header_host, &light_samples, &weights, &order, &triangles,
                               &list, &slots, &resume, &walked})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::gears
