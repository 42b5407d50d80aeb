#include "techniques/alias_free_shadow_map/caster_pass.h"

#include <algorithm>
#include <array>

#include "shaders/alias_free_cast_inner.h"
#include "shaders/alias_free_cast_items.h"
#include "shaders/alias_free_cast_triangles.h"
#include "shaders/alias_free_make_items.h"

namespace penumbra::alias_free {
namespace {

// Crowded triangles of one round are so few that their items cannot exceed this, whatever they cover.
constexpr uint32_t item_capacity = 1 << 21;
// View samples of a row in one dispatch, a turn of a loop each; see cast_items.comp.
constexpr uint32_t item_turns = 32768;
constexpr uint32_t strips = 64;  // as cast_triangles.comp

uint64_t groups_of(uint64_t invocations) { return (invocations + group_lanes - 1) / group_lanes; }

}  // namespace

uint32_t CasterPass::items_per_triangle() const {
  return std::max(small_rows, (static_cast<uint32_t>(params_.grid_size) + item_rows - 1) / item_rows);
}

void CasterPass::setup(const Case& c) {
  gpu::Device& device = *c.device;
  const bool parallel = at_infinity(c.frame->light);
  const gpu::ImageUse uses[] = {gpu::ImageUse::sampled_nearest, gpu::ImageUse::sampled_nearest,
                                gpu::ImageUse::uniform_block};
  for (uint32_t counting = 0; counting < 2; ++counting) {
    const gpu::Specialization constants[] = {{0, counting}, {1, item_turns}, {3, parallel}};
    const auto make = [&](const auto& code) {
      return gpu::ComputePipeline(device, code, sizeof(CastPush), constants, uses);
    };
    kernels_[counting] = {make(alias_free_cast_triangles_spv), make(alias_free_make_items_spv),
                          make(alias_free_cast_items_spv), make(alias_free_cast_inner_spv)};
  }
  progress_ = gpu::Buffer(device, sizeof(Progress), gpu::Memory::device, "counts");
  progress_host_ = gpu::Buffer(device, sizeof(Progress), gpu::Memory::read_back, "counts");
}

void CasterPass::build(const Case& c, const Casters& casters) {
  const uint64_t triangles = std::max(casters.triangle_count(), 1U);
  gpu::ensure(crowded_, *c.device, triangles * 8, gpu::Memory::device, "crowded triangles");
  const uint64_t items = std::min<uint64_t>(item_capacity, triangles * items_per_triangle());
  gpu::ensure(items_, *c.device, items * 8, gpu::Memory::device, "items of crowded triangles");
}

void CasterPass::bind(const Casters& casters, const Fitter& fitter, const SampleLists& lists) {
  for (Kernels& k : kernels_)
    for (gpu::ComputePipeline* p : {&k.triangles, &k.make_items, &k.items, &k.inner}) {
      p->bind_images(std::array{casters.corners().view(), lists.list_texels().view()});
      p->bind_block(fitter.view_buffer());
    }
}

void CasterPass::run(const Casters& casters, const Fitter& fitter, const SampleLists& lists,
                     gpu::PassRecorder& passes) {
  cast(casters, fitter, lists, false, passes);
}

void CasterPass::cast(const Casters& casters, const Fitter& fitter, const SampleLists& lists, bool counting,
                      gpu::PassRecorder& passes) {
  passes.finish();
  bind(casters, fitter, lists);
  CastPush pc{};
  pc.offsets = lists.offsets().address(), pc.blocked = lists.blocked().address();
  pc.casters = casters.list().address(), pc.boxes = casters.boxes().address();
  pc.crowded = crowded_.address(), pc.items = items_.address(), pc.progress = progress_.address();
  const Kernels& kernels = kernels_[counting];
  cast_all(pc, 0, casters.caster_count(), fitter, kernels, passes);
  if (casters.caster_count() == 0 || !fitter.any_used()) read(passes, "cast_triangles");
  const uint32_t inner = progress_read().inner_count, fronts = casters.front_count();
  if (inner == 0 || fronts == 0) return;
  pc.first = casters.triangle_count() - fronts, pc.count = fronts;
  if (inner > most_inner) return cast_all(pc, pc.first, fronts, fitter, kernels, passes);
  passes.device_pass("cast_inner", [&](gpu::Commands& commands) {
    commands.dispatch(kernels.inner, pc, groups_of((fronts + front_block - 1) / front_block));
  });
}

// `count` entries of the list of casters from `first` on.
void CasterPass::cast_all(CastPush pc, uint32_t first, uint32_t count, const Fitter& fitter,
                          const Kernels& kernels, gpu::PassRecorder& passes) {
  constexpr uint32_t per_group = group_lanes * triangles_per_lane;
  pc.first = first, pc.count = count, pc.groups = (count + per_group - 1) / per_group;
  const uint64_t dispatched = (uint64_t{pc.groups} + strips - 1) / strips * strips;
  for (pc.face = 0; pc.face < most_faces; ++pc.face) {
    if (!fitter.used(pc.face) || count == 0) continue;
    passes.device_pass("cast_triangles", [&](gpu::Commands& commands) {
      commands.fill(progress_, 0, offsetof(Progress, crowded_count), sizeof(uint32_t));
      commands.barrier();
      commands.dispatch(kernels.triangles, pc, dispatched);
      commands.barrier();
      commands.copy(progress_, progress_host_, sizeof(Progress));
    });
    passes.finish();
    cast_crowded(pc, kernels, passes);
  }
}

// The triangles that are left, so many at once that their items have room.
void CasterPass::cast_crowded(CastPush pc, const Kernels& kernels, gpu::PassRecorder& passes) {
  const uint32_t crowded = progress_read().crowded_count,
                 chunk = std::max(item_capacity / items_per_triangle(), 1U);
  for (uint32_t done = 0; done < crowded; done += chunk) {
    pc.first = done, pc.count = std::min(chunk, crowded - done);
    passes.device_pass("cast_items", [&](gpu::Commands& commands) {
      commands.fill(progress_, 0, 0, offsetof(Progress, pairs));
      commands.barrier();
      commands.dispatch(kernels.make_items, pc, groups_of(pc.count));
      commands.barrier();
      commands.copy(progress_, progress_host_, sizeof(Progress));
    });
    passes.finish();
    pc.first = 0, pc.count = progress_read().item_count;
    if (pc.count == 0) continue;
    do {
      passes.device_pass("cast_items", [&](gpu::Commands& commands) {
        commands.dispatch(kernels.items, pc, groups_of(uint64_t{pc.count} * item_rows));
        commands.barrier();
        commands.copy(progress_, progress_host_, sizeof(Progress));
      });
      passes.finish();
      pc.first += item_turns;
    } while (pc.first < progress_read().longest);
  }
}

void CasterPass::read(gpu::PassRecorder& passes, const char* pass) {
  passes.device_pass(
      pass, [&](gpu::Commands& commands) { commands.copy(progress_, progress_host_, sizeof(Progress)); });
  passes.finish();
}

double CasterPass::count_pairs(const Casters& casters, const Fitter& fitter, const SampleLists& lists,
                               gpu::PassRecorder& passes) {
  passes.device_pass("read", [&](gpu::Commands& commands) {
    commands.fill(progress_, 0, offsetof(Progress, pairs), sizeof Progress::pairs);
  });
  cast(casters, fitter, lists, true, passes);
  read(passes, "read");
  const Progress p = progress_read();
  return p.pairs[0] + 4294967296.0 * p.pairs[1];
}

}  // namespace penumbra::alias_free
