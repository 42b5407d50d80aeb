#include "techniques/alias_free_shadow_map/fitter.h"

#include "shaders/alias_free_bounds.h"

namespace penumbra::alias_free {
namespace {

constexpr float no_limit = 3e38F;

bool begins_exactly(const Params& params, const Case& c) {
  return params.origin == Origin::exact || (params.origin == Origin::automatic && c.frame->geometry.closed);
}

}  // namespace

void Fitter::setup(const Case& c) {
  gpu::Device& device = *c.device;
  const uint32_t parallel = at_infinity(c.frame->light);
  const gpu::Specialization gather[] = {{0, 1}, {3, parallel}, {4, !begins_exactly(params_, c)}},
                            bound[] = {{0, 0}, {3, parallel}};
  gather_ = gpu::ComputePipeline(device, alias_free_bounds_spv, sizeof(BoundsPush), gather);
  bound_ = gpu::ComputePipeline(device, alias_free_bounds_spv, sizeof(BoundsPush), bound);
  view_buffer_ = gpu::Buffer(device, sizeof(LightView), gpu::Memory::device, "the light's view");
  bounds_ =
      gpu::Buffer(device, most_faces * sizeof(SampleBounds), gpu::Memory::device, "view samples' bounds");
  read_back_ =
      gpu::Buffer(device, most_faces * sizeof(SampleBounds), gpu::Memory::read_back, "view samples' bounds");
}

const LightView& Fitter::run(const RenderInput& in, gpu::PassRecorder& passes) {
  const Case& c = *in.scene_case;
  const Box& scene = c.frame->geometry.bounds;
  diagonal_ = double(scene.diagonal());
  light_ = light_point(c.frame->light);
  view_ = begin_view(light_, scene);
  view_.grid_size = static_cast<uint32_t>(params_.grid_size);
  std::fill(std::begin(used_), std::end(used_), false);
  gather(in, passes);
  if (params_.fit)
    fit_samples(in, passes);
  else
    passes.host_pass("fit", [&] { fit_scene(c); });
  passes.device_pass("fit_upload",
                     [&](gpu::Commands& commands) { commands.update(view_buffer_, &view_, sizeof view_); });
  return view_;
}

void Fitter::fit_samples(const RenderInput& in, gpu::PassRecorder& passes) {
  const Frame& frame = *in.scene_case->frame;
  const auto extent = [&](uint32_t slot) { return decode(read_back_.view<SampleBounds>()[slot]); };
  bool none = false;
  passes.host_pass("fit", [&] {
    const Extent box = extent(0);
    none = box.empty();
    for (int i = 0; i < 3 && !none; ++i)
      view_.sample_lo[i] = static_cast<float>(box.lo[i]), view_.sample_hi[i] = static_cast<float>(box.hi[i]);
    aim(view_, light_, none ? Vec3d{} : 0.5 * (box.lo + box.hi) - Vec3d(view_.center.xyz()),
        frame.camera.basis().forward);
    if (none) set_window(view_, 0, {{0, 0, 0}, {1, 1, 1}}, diagonal_);
  });
  if (none) return;
  bound(1, light_.at_infinity() ? no_limit : static_cast<float>(widest_tangent), passes);
  bool whole = true;
  passes.host_pass("fit", [&] {
    whole = extent(0).whole;
    if (whole)
      cover(0, extent(0));
    else
      aim_cube(view_);
  });
  if (whole) return;
  bound(most_faces, static_cast<float>(face_tangent), passes);
  passes.host_pass("fit", [&] {
    for (uint32_t f = 0; f < most_faces; ++f) cover(f, extent(f));
  });
}

void Fitter::cover(uint32_t face, const Extent& extent) {
  used_[face] = !extent.empty();
  set_window(view_, face, used_[face] ? extent : Extent{{0, 0, 0}, {1, 1, 1}}, diagonal_);
}

// No fitting: the windows cover the scene's bounds, or a spot's cone.
void Fitter::fit_scene(const Case& c) {
  const Box& box = c.frame->geometry.bounds;
  // Offset origins may leave the bounds.
  const double offset = begins_exactly(params_, c) ? 0 : 2 * double(relative_offset) * diagonal_;
  const Vec3d out{offset, offset, offset}, center(view_.center.xyz());
  for (int i = 0; i < 3; ++i) {
    view_.sample_lo[i] = box.lo[i] - static_cast<float>(offset);
    view_.sample_hi[i] = box.hi[i] + static_cast<float>(offset);
  }
  const Vec3d lo = Vec3d(box.lo) - out - center, hi = Vec3d(box.hi) + out - center;
  aim(view_, light_, 0.5 * (lo + hi), c.frame->camera.basis().forward);
  if (const auto whole = extent_of(view_, lo, hi)) {
    cover(0, *whole);
  } else if (light_.spot) {
    const double tangent = face_tangent * light_.cone_tangent();
    cover(0, {{-tangent, -tangent, 0}, {tangent, tangent, 1}});
  } else {
    aim_cube(view_);
    for (uint32_t f = 0; f < most_faces; ++f)
      cover(f, {{-face_tangent, -face_tangent, 0}, {face_tangent, face_tangent, 1}});
  }
}

// Where shadow segments begin, packed, and the box of those that face the light.
void Fitter::gather(const RenderInput& in, gpu::PassRecorder& passes) {
  const ViewSamples& view = *in.view_samples;
  pixels_ = static_cast<uint32_t>(view.width() * view.height());
  gpu::ensure(samples_, passes.device(), std::size_t{pixels_} * sizeof(Vec4f), gpu::Memory::device,
              "shadow segments' beginnings");
  BoundsPush push{};
  push.position = view.position().address();
  push.origin = view.origin().address();
  push.normal = view.geometric_normal().address();
  push.triangle = view.triangle().address();
  reduce("gather", gather_, push, 1, passes);
}

// What the view samples cover of each of the first faces.
void Fitter::bound(uint32_t faces, float limit, gpu::PassRecorder& passes) {
  BoundsPush push{};
  push.limit = limit;
  reduce("fit_window", bound_, push, faces, passes);
}

void Fitter::reduce(const char* pass, const gpu::ComputePipeline& kernel, BoundsPush push, uint32_t faces,
                    gpu::PassRecorder& passes) {
  push.frame = view_buffer_.address();
  push.samples = samples_.address();
  push.bounds = bounds_.address();
  push.count = pixels_;
  constexpr uint32_t per_group = group_lanes * samples_per_lane;
  passes.device_pass(pass, [&](gpu::Commands& commands) {
    commands.update(view_buffer_, &view_, sizeof view_);
    commands.fill(bounds_, 0xffffffffU);
    commands.barrier();
    for (push.face = 0; push.face < faces; ++push.face)
      commands.dispatch(kernel, push, (push.count + per_group - 1) / per_group);
    commands.barrier();
    commands.copy(bounds_, read_back_, bounds_.bytes());
  });
  passes.finish();
}

}  // namespace penumbra::alias_free
