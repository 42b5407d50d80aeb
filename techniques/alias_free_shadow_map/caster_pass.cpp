#include "techniques/alias_free_shadow_map/caster_pass.h"

#include <algorithm>

#include "shaders/alias_free_cast_inner.h"
#include "shaders/alias_free_cast_items.h"
#include "shaders/alias_free_cast_triangles.h"
#include "shaders/alias_free_cull_triangles.h"

namespace penumbra::alias_free {
namespace {

// Triangles of one dispatch are so many that their items cannot exceed this, whatever they cover.
constexpr uint32_t item_capacity = 1 << 21;
// View samples of a row in one dispatch, a turn of a loop each; see cast_items.comp.
constexpr uint32_t item_turns = 32768;
constexpr uint32_t strips = 64;  // as cast_triangles.comp

uint64_t groups_of(uint32_t triangles) {
  constexpr uint32_t per_group = group_lanes * triangles_per_lane;
  return (uint64_t{triangles} + per_group - 1) / per_group;
}

}  // namespace

uint32_t CasterPass::items_per_triangle() const {
  return std::max(small_rows, (static_cast<uint32_t>(params_.grid_size) + item_rows - 1) / item_rows);
}

void CasterPass::setup(const Case& c) {
  gpu::Device& device = *c.device;
  const bool parallel = at_infinity(c.frame->light);
  for (uint32_t counting = 0; counting < 2; ++counting) {
    const gpu::Specialization constants[] = {{0, counting}, {1, item_turns}, {3, parallel}};
    const auto make = [&](const auto& code) {
      return gpu::ComputePipeline(device, code, sizeof(CastPush), constants);
    };
    kernels_[counting] = {make(alias_free_cast_triangles_spv), make(alias_free_cast_items_spv),
                          make(alias_free_cast_inner_spv)};
    if (!counting) cull_ = make(alias_free_cull_triangles_spv);
  }
  progress_ = gpu::Buffer(device, sizeof(Progress), gpu::Memory::device, "counts");
  progress_host_ = gpu::Buffer(device, sizeof(Progress), gpu::Memory::read_back, "counts");
}

void CasterPass::build(const Case& c, gpu::PassRecorder& passes) {
  const Geometry& g = c.frame->geometry;
  triangle_count_ = static_cast<uint32_t>(g.triangle_count());
  std::vector<uint32_t> bits((g.triangle_count() + 31) / 32 + 1, 0U);
  for (std::size_t t = 0; t < g.triangle_count(); ++t)
    if (g.in_closed_mesh(t)) bits[t / 32] |= 1U << (t % 32);
  gpu::ensure(closed_, *c.device, bits.size() * 4, gpu::Memory::device, "closed meshes' triangles");
  gpu::upload(passes, "upload_closed", closed_, bits.data(), bits.size() * 4);
  gpu::ensure(casters_, *c.device, std::max<uint64_t>(triangle_count_, 1) * 4, gpu::Memory::device,
              "triangles that cast");
  const std::vector<uint32_t> none(std::max(triangle_count_, 1U), 0U);
  gpu::ensure(away_, *c.device, none.size() * 4, gpu::Memory::device, "triangles turned away");
  gpu::upload(passes, "upload_closed", away_, none.data(), none.size() * 4);
  const uint64_t items = std::min<uint64_t>(item_capacity, uint64_t{triangle_count_} * items_per_triangle());
  gpu::ensure(items_, *c.device, std::max<uint64_t>(items, 1) * 8, gpu::Memory::device,
              "items of large triangles");
}

void CasterPass::cull(const Case& c, const Fitter& fitter, gpu::PassRecorder& passes) {
  CastPush pc = push(c, fitter);
  pc.count = triangle_count_;
  passes.device_pass("cull_triangles", [&](gpu::Commands& commands) {
    commands.fill(progress_, 0);
    commands.barrier();
    if (pc.count > 0) commands.dispatch(cull_, pc, groups_of(pc.count));
  });
}

CastPush CasterPass::push(const Case& c, const Fitter& fitter) const {
  CastPush pc{};
  pc.frame = fitter.view_buffer().address();
  pc.positions = c.geometry->positions.address();
  pc.indices = c.geometry->indices.address();
  pc.closed = closed_.address();
  pc.away = away_.address();
  pc.casters = casters_.address();
  pc.items = items_.address();
  pc.progress = progress_.address();
  return pc;
}

void CasterPass::run(const Case& c, const Fitter& fitter, const SampleLists& lists,
                     gpu::PassRecorder& passes) {
  cast(c, fitter, lists, false, passes);
}

void CasterPass::cast(const Case& c, const Fitter& fitter, const SampleLists& lists, bool counting,
                      gpu::PassRecorder& passes) {
  CastPush pc = push(c, fitter);
  pc.offsets = lists.offsets().address();
  pc.lists = lists.lists().address();
  pc.blocked = lists.blocked().address();
  passes.device_pass("cast_begin", [&](gpu::Commands& commands) {
    commands.fill(progress_, 0, 0, offsetof(Progress, inner_count));
    commands.barrier();
    commands.copy(progress_, progress_host_, sizeof(Progress));
  });
  passes.finish();
  const Progress found = read_progress();
  const Kernels& kernels = kernels_[counting];
  cast_all(pc, 0, found.caster_count, fitter, kernels, passes);
  if (found.inner_count == 0 || found.front_count == 0) return;
  const uint32_t fronts = triangle_count_ - found.front_count;
  if (found.inner_count > most_inner) return cast_all(pc, fronts, found.front_count, fitter, kernels, passes);
  pc.first = fronts, pc.count = found.front_count;
  passes.device_pass("cast_inner", [&](gpu::Commands& commands) {
    commands.dispatch(kernels.inner, pc, groups_of(pc.count));
  });
}

// `count` entries of the list of casters from `first` on.
void CasterPass::cast_all(CastPush pc, uint32_t first, uint32_t count, const Fitter& fitter,
                          const Kernels& kernels, gpu::PassRecorder& passes) {
  const uint32_t chunk = std::max(item_capacity / items_per_triangle(), 1U);
  for (pc.face = 0; pc.face < most_faces; ++pc.face)
    for (uint32_t done = 0; fitter.used(pc.face) && done < count; done += chunk) {
      pc.first = first + done, pc.count = std::min(chunk, count - done);
      cast_chunk(pc, kernels, passes);
    }
}

void CasterPass::cast_chunk(CastPush pc, const Kernels& kernels, gpu::PassRecorder& passes) {
  pc.groups = static_cast<uint32_t>(groups_of(pc.count));
  const uint64_t dispatched = (uint64_t{pc.groups} + strips - 1) / strips * strips;
  passes.device_pass("cast_triangles", [&](gpu::Commands& commands) {
    commands.fill(progress_, 0, 0, offsetof(Progress, pairs));
    commands.barrier();
    commands.dispatch(kernels.triangles, pc, dispatched);
    commands.barrier();
    commands.copy(progress_, progress_host_, sizeof(Progress));
  });
  passes.finish();
  pc.count = read_progress().item_count;
  pc.first = 0;
  if (pc.count == 0) return;
  do {
    passes.device_pass("cast_items", [&](gpu::Commands& commands) {
      commands.dispatch(kernels.items, pc, (uint64_t{pc.count} * item_rows + group_lanes - 1) / group_lanes);
      commands.barrier();
      commands.copy(progress_, progress_host_, sizeof(Progress));
    });
    passes.finish();
    pc.first += item_turns;
  } while (pc.first < read_progress().longest);
}

double CasterPass::count_pairs(const Case& c, const Fitter& fitter, const SampleLists& lists,
                               gpu::PassRecorder& passes) {
  cast(c, fitter, lists, true, passes);
  passes.device_pass(
      "read", [&](gpu::Commands& commands) { commands.copy(progress_, progress_host_, sizeof(Progress)); });
  passes.finish();
  const Progress p = read_progress();
  return p.pairs[0] + 4294967296.0 * p.pairs[1];
}

uint64_t CasterPass::bytes() const {
  return closed_.bytes() + away_.bytes() + casters_.bytes() + items_.bytes() + progress_.bytes() +
         progress_host_.bytes();
}

}  // namespace penumbra::alias_free
