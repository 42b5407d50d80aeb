#include "techniques/sample_based_soft/sample_lists.h"

#include <algorithm>

#include "shaders/sample_based_soft_bin_samples.h"
#include "shaders/sample_based_soft_measure_lists.h"
#include "shaders/sample_based_soft_project.h"

namespace penumbra::sample_based_soft {
namespace {

constexpr uint32_t most_bins = 1 << 19, most_slices = 32;

}  // namespace

void SampleLists::setup(const FrameState& state) {
  gpu::Device& device = *state.device;
  slices_ = std::clamp(most_bins / state.lists(), 1u, most_slices);
  const gpu::Specialization lanes[] = {{0, state.lanes}};
  const gpu::ImageUse images[] = {gpu::ImageUse::sampled_nearest};
  project_ =
      gpu::ComputePipeline(device, sample_based_soft_project_spv, sizeof(SamplesConstants), lanes, images);
  for (uint32_t stage = 0; stage < 2; ++stage) {
    // SG, by which slots are counted, is also the workgroup's size there.
    const gpu::Specialization bin[] = {{0, state.lanes}, {1, stage}, {2, state.params.fit}};
    const gpu::Specialization measure[] = {{1, stage}};
    bin_[stage] =
        gpu::ComputePipeline(device, sample_based_soft_bin_samples_spv, sizeof(SamplesConstants), bin);
    measure_[stage] =
        gpu::ComputePipeline(device, sample_based_soft_measure_lists_spv, sizeof(SamplesConstants), measure);
  }
  bin_scan_.setup(device, state.lanes);
  groups_.setup(device, state.lanes, true);
  group_scan_.setup(device, state.lanes, state.lanes);
}

void SampleLists::bind(const FrameState& state) {
  const VkImageView views[] = {state.frame_texels.view()};
  project_.bind_images(views);
  groups_.bind(state.frame_texels.view(), state.view_texels.origin.view(), state.view_texels.normal.view());
}

uint32_t SampleLists::group_capacity(const FrameState& state) const {
  // Each list may leave its last group unfilled, but no list has less than one view sample.
  const uint64_t full = groups_for(state.pixels(), state.lanes);
  return static_cast<uint32_t>(std::min<uint64_t>(full + state.lists(), state.pixels()) + 1);
}

void SampleLists::allocate(const FrameState& state) {
  const auto words = [&](gpu::Buffer& b, std::size_t count, const char* what) {
    gpu::ensure(b, *state.device, count * 4, gpu::Memory::device, what);
  };
  const std::size_t pixels = state.pixels(), lists = state.lists(), bins = lists * slices_ + 1;
  words(places_, pixels * 4, "view samples in the light's view");
  words(bins_, pixels * 2, "bins of the view samples");
  words(counts_, bins, "bins of the view samples");
  words(begins_, bins, "bins of the view samples");
  words(farthest_, lists + state.tiles(), "far planes of the lists");
  words(lengths_, lists + 1, "lengths of the lists");
  words(first_groups_, lists + 1, "groups of the lists");
  words(slots_, std::size_t{group_capacity(state)} * state.lanes, "lists of view samples");
  words(group_lists_, group_capacity(state), "lists of the groups");
  words(bin_scratch_, bin_scan_.scratch_bytes(static_cast<uint32_t>(bins)) / 4, "prefix sums");
  words(group_scratch_, group_scan_.scratch_bytes(state.lists() + 1) / 4, "prefix sums");
  gpu::ensure(scratch_host_, *state.device, 16, gpu::Memory::read_back, "totals");
}

void SampleLists::run(const FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  allocate(state);
  SamplesConstants pc{};
  pc.frame = state.frame.address();
  pc.header = state.header.address();
  pc.origin = in.view_samples->origin().address();
  pc.normal = in.view_samples->geometric_normal().address();
  pc.places = places_.address();
  pc.bins = bins_.address();
  pc.counts = counts_.address();
  pc.begins = begins_.address();
  pc.farthest = farthest_.address();
  pc.lengths = lengths_.address();
  pc.first_groups = first_groups_.address();
  pc.slots = slots_.address();
  pc.group_lists = group_lists_.address();
  pc.pixels = state.pixels();
  pc.grid_size = state.grid_size();
  pc.slices = slices_;
  pc.slack = state.light.slack;
  passes.device_pass("project_samples", [&](gpu::Commands& commands) {
    commands.dispatch(project_, pc, groups_for(state.pixels(), state.lanes * pixels_per_lane));
  });
  passes.device_pass("bin_samples", [&](gpu::Commands& commands) {
    const uint32_t lists = state.lists();
    for (const gpu::Buffer* b : {&counts_, &farthest_, &lengths_}) commands.fill(*b, 0);
    commands.fill(slots_, 0xffffffffU);
    commands.barrier();
    commands.dispatch(bin_[0], pc, groups_for(state.pixels(), state.lanes * pixels_per_lane));
    commands.barrier();
    bin_scan_.record(commands, counts_, begins_, bin_scratch_, lists * slices_ + 1);
    commands.dispatch(measure_[0], pc, groups_for(lists, wide_lanes));
    commands.dispatch(measure_[1], pc, groups_for(state.tiles(), wide_lanes));
    commands.barrier();
    group_scan_.record(commands, lengths_, first_groups_, group_scratch_, lists + 1);
    commands.dispatch(bin_[1], pc, groups_for(state.pixels(), state.lanes * pixels_per_lane));
    commands.copy(group_scratch_, scratch_host_, 8);
  });
  passes.finish();
  const SampleGroups::Lists lists{slots_.address(), group_lists_.address(), first_groups_.address(),
                                  lengths_.address(), group_count()};
  passes.device_pass("group_samples", [&](gpu::Commands& commands) { groups_.arrange(commands, lists); });
}

uint32_t SampleLists::group_count() const {
  return static_cast<uint32_t>(PrefixScan::total(scratch_host_.view<uint32_t>().data()));
}

uint64_t SampleLists::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&places_, &bins_, &counts_, &begins_, &farthest_, &lengths_, &first_groups_,
                               &slots_, &group_lists_, &bin_scratch_, &group_scratch_, &scratch_host_})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::sample_based_soft
