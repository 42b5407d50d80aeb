#include "techniques/shadow_map/fitter.h"

#include "shaders/shadow_map_fit.h"

namespace penumbra::shadow_map {
namespace {

constexpr uint32_t pixels_per_group = 64 * 16;  // as fit.comp
constexpr double no_limit = 1e30;
// Faces overlap by this much, so that a view sample on the border between two is in the bounds of both.
constexpr double face_tangent = 1.0001;

const Vec3d fixed_hint{0, 1, 0};

// Lights that shine to all sides: one frustum where it can hold all view samples, else six faces.
bool may_need_faces(const LightPoint& light) { return !light.at_infinity() && !light.spot; }

}  // namespace

void Fitter::setup(gpu::Device& device) {
  reduce_ = gpu::ComputePipeline(device, shadow_map_fit_spv, sizeof(FitPush));
  queries_ =
      gpu::Buffer(device, max_layers * sizeof(FitQuery), gpu::Memory::upload, "shadow map fit queries");
  bounds_ =
      gpu::Buffer(device, max_layers * sizeof(SampleBounds), gpu::Memory::device, "shadow map fit bounds");
  read_back_ =
      gpu::Buffer(device, max_layers * sizeof(SampleBounds), gpu::Memory::read_back, "shadow map fit bounds");
}

const Fitted& Fitter::run(const Case& c, const ViewSamples& view_samples, gpu::PassRecorder& passes) {
  if (params_.fit == Fit::none) {
    passes.host_pass("fit", [&] { reset(c), fit_scene(c), crop_layers(c); });
    return fitted_;
  }
  passes.host_pass("fit", [&] {
    reset(c);
    query(0, Mat4d{}, -no_limit, no_limit, no_limit);
  });
  if (needs_sample_box()) {
    reduce("fit_samples", 1, view_samples, passes);
    passes.host_pass("fit", [&] {
      const Extent e = decode(read_back_.view<SampleBounds>()[0]);
      if (!e.empty()) sample_box_ = {Vec3f(e.lo), Vec3f(e.hi)}, view_lo_ = e.view_lo, view_hi_ = e.view_hi;
    });
  }
  passes.host_pass("fit", [&] { aim(c), query_layers(); });
  reduce("fit_bounds", static_cast<int>(fitted_.layers.size()), view_samples, passes);
  bool faces = false;
  passes.host_pass("fit", [&] {
    faces = may_need_faces(fitted_.light) && !decode(read_back_.view<SampleBounds>()[0]).whole;
    if (faces) aim_faces(), query_layers();
  });
  if (faces) reduce("fit_bounds", static_cast<int>(fitted_.layers.size()), view_samples, passes);
  passes.host_pass("fit", [&] { cover_samples(), crop_layers(c); });
  return fitted_;
}

void Fitter::reset(const Case& c) {
  fitted_.light = light_point(c.frame->light);
  fitted_.six_faces = false;
  fitted_.layers.clear();
  sample_box_ = c.frame->geometry.bounds;
  view_lo_ = c.frame->camera.near_plane, view_hi_ = no_limit;
}

// Directions and cones are given; towards which side a point light looks depends on where the view samples
// are.
bool Fitter::needs_sample_box() const { return may_need_faces(fitted_.light); }

void Fitter::add_layer(Vec3d forward, Vec3d hint) {
  FittedLayer layer;
  layer.frame = light_frame(forward, hint);
  layer.space_from_world = light_from_world(fitted_.light, layer.frame);
  fitted_.layers.push_back(layer);
}

void Fitter::aim(const Case& c) {
  limit_ = may_need_faces(fitted_.light) ? widest_tangent : no_limit;
  // A stable fit must not turn with what the camera sees.
  const bool tight = params_.fit == Fit::tight;
  const Box& box = tight ? sample_box_ : c.frame->geometry.bounds;
  const Vec3d position = fitted_.light.towards.xyz();
  add_layer(may_need_faces(fitted_.light) ? Vec3d(box.center()) - position : fitted_.light.axis,
            tight ? c.frame->camera.basis().forward : fixed_hint);
}

void Fitter::aim_faces() {
  fitted_.six_faces = true, limit_ = face_tangent;
  fitted_.layers.clear();
  for (int axis = 0; axis < 3; ++axis)
    for (double sign : {1.0, -1.0}) {
      Vec3d forward, hint;  // the cube's axes: only then do the faces meet
      forward[axis] = sign, hint[(axis + 1) % 3] = 1;
      add_layer(forward, hint);
    }
}

void Fitter::query_layers() {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    const FittedLayer& l = fitted_.layers[i];
    query(static_cast<int>(i), l.space_from_world, l.view_lo, l.view_hi, limit_);
  }
}

void Fitter::query(int slot, const Mat4d& space, double view_lo, double view_hi, double limit) {
  queries_.view<FitQuery>()[static_cast<std::size_t>(slot)] = {
      to_float(space),
      fitted_.light.device_towards(),
      fitted_.light.device_emission(),
      {static_cast<float>(view_lo), static_cast<float>(view_hi), static_cast<float>(limit), 0}};
}

void Fitter::reduce(const char* pass, int slots, const ViewSamples& view_samples, gpu::PassRecorder& passes) {
  const auto count = static_cast<uint32_t>(view_samples.width() * view_samples.height());
  const uint64_t bytes = static_cast<uint64_t>(slots) * sizeof(SampleBounds);
  passes.device_pass(pass, [&](gpu::Commands& commands) {
    commands.fill(bounds_, 0xffffffffU);
    commands.barrier();
    for (int i = 0; i < slots; ++i) {
      const FitPush push{queries_.address(),
                         bounds_.address(),
                         view_samples.position().address(),
                         view_samples.geometric_normal().address(),
                         count,
                         static_cast<uint32_t>(i)};
      commands.dispatch(reduce_, push, (count + pixels_per_group - 1) / pixels_per_group);
    }
    commands.barrier();
    commands.copy(bounds_, read_back_, bytes);
  });
}

void Fitter::cover_samples() {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    FittedLayer& layer = fitted_.layers[i];
    layer.extent = decode(read_back_.view<SampleBounds>()[i]);
    layer.used = !layer.extent.empty();
    if (!layer.used)
      layer.extent.extend({0, 0, -1}), layer.extent.extend({1, 1, -0.5});
    else if (params_.fit == Fit::stable)
      layer.extent = snapped(layer.extent, params_.map_size, params_.border_texels());
  }
}

void Fitter::crop_layers(const Case& c) {
  // A plane at right angles to the light has one depth; its map still needs some to tell it from its casters.
  const double diagonal = double(c.frame->geometry.bounds.diagonal());
  for (FittedLayer& layer : fitted_.layers) {
    const double least = fitted_.light.at_infinity() ? 1e-3 * diagonal : 1e-3 * std::abs(layer.extent.lo.z);
    layer.clip_from_world =
        crop(layer.extent, params_.map_size, params_.border_texels(), least) * layer.space_from_world;
  }
}

// No fitting: the map covers the scene's bounds, or a spot's cone.
void Fitter::fit_scene(const Case& c) {
  aim(c);
  const Box& box = c.frame->geometry.bounds;
  const std::optional<Extent> whole = extent_of(box, fitted_.layers[0].space_from_world, limit_);
  if (whole && !fitted_.light.spot) {
    fitted_.layers[0].extent = *whole;
    return;
  }
  if (!fitted_.light.spot) aim_faces();
  double farthest = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3f corner{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
    farthest = std::max(farthest, length(Vec3d(corner) - fitted_.light.towards.xyz()));
  }
  const double cosine = fitted_.light.cosine;
  const double tangent = fitted_.six_faces ? face_tangent : std::sqrt(1 - cosine * cosine) / cosine;
  for (FittedLayer& layer : fitted_.layers) {
    // Depth clamp keeps what is nearer than the near plane.
    layer.extent.extend({-tangent, -tangent, -1 / (1e-3 * farthest)});
    layer.extent.extend({tangent, tangent, -1 / farthest});
  }
}

}  // namespace penumbra::shadow_map
