#include "techniques/common/shadow_maps/fitter.h"

#include "core/error.h"
#include "shaders/shadow_map_fit.h"
#include "techniques/common/shadow_maps/warp.h"

namespace penumbra::shadow_map {
namespace {

constexpr uint32_t pixels_per_group = 64 * 16;  // as fit.comp
constexpr double no_limit = 1e30;
// Depth that a plane at right angles to the light still gets, to tell it from its casters: a share of the
// diagonal.
constexpr double least_depth_share = 1e-3;

const Vec3d fixed_hint{0, 1, 0};

template <class F>
void for_each_corner(const Box& box, F&& f) {
  for (int i = 0; i < 8; ++i)
    f(Vec3d(Vec3f{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z}));
}

// Towards the middle of what a box spans as seen from a point: of a long box near by, its centre is far from
// that.
Vec3d middle_direction(Vec3d from, const Box& box) {
  Vec3d sum{};
  for_each_corner(box, [&](Vec3d p) {
    if (const double d = length(p - from); d > 0) sum += (p - from) / d;
  });
  return length(sum) > 0.5 ? sum : Vec3d(box.center()) - from;
}

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

const Fitted& Fitter::run(const Case& c, const LightPoint& light, const ViewSamples& view_samples,
                          gpu::PassRecorder& passes) {
  if (params_.fit == Fit::none) {
    passes.host_pass("fit", [&] { reset(c, light), fit_scene(c), crop_layers(c); });
    return fitted_;
  }
  passes.host_pass("fit", [&] { reset(c, light), query(0, Mat4d{}, -no_limit, no_limit, no_limit); });
  if (needs_sample_box()) reduce("fit_samples", 1, view_samples, passes);
  passes.host_pass("fit", [&] {
    const Extent e = needs_sample_box() ? decode(read_back_.view<SampleBounds>()[0]) : Extent{};
    if (!e.empty()) sample_box_ = {Vec3f(e.lo), Vec3f(e.hi)}, view_lo_ = e.view_lo, view_hi_ = e.view_hi;
    aim(c, Aim::center), query_layers();
  });
  const auto reduce_layers = [&] {
    reduce("fit_bounds", static_cast<int>(fitted_.layers.size()), view_samples, passes);
  };
  reduce_layers();
  if (may_need_faces(fitted_.light) && outside()) {
    passes.host_pass("fit", [&] { aim(c, Aim::middle), query_layers(); });
    reduce_layers();
  }
  if (may_need_faces(fitted_.light) && outside()) {
    if (params_.cascades > 1 || params_.warp != Warp::none)
      throw UnsupportedError(
          "The view samples lie so far around the light that it takes six faces, which take neither cascades "
          "nor a warp.");
    passes.host_pass("fit", [&] { aim_faces(), query_layers(); });
    reduce_layers();
  }
  passes.host_pass("fit", [&] { cover_samples(c), plan_warps(c); });
  if (params_.warp != Warp::none) {
    reduce_layers();
    passes.host_pass("fit", [&] { cover_warped(); });
  }
  passes.host_pass("fit", [&] { crop_layers(c); });
  return fitted_;
}

void Fitter::reset(const Case& c, const LightPoint& light) {
  fitted_.light = light;
  fitted_.six_faces = false;
  fitted_.layers.clear();
  sample_box_ = c.frame->geometry.bounds;
  view_lo_ = c.frame->camera.near_plane, view_hi_ = 2 * view_lo_;
}

// Directions and cones are given; towards which side a point light looks depends on where the view samples
// are, and splits and warps on their view depths.
bool Fitter::needs_sample_box() const {
  return may_need_faces(fitted_.light) || params_.cascades > 1 || params_.warp != Warp::none;
}

void Fitter::add_layer(const LightFrame& frame) {
  FittedLayer layer;
  layer.frame = frame;
  layer.space_from_world = light_from_world(fitted_.light, layer.frame);
  fitted_.layers.push_back(layer);
}

void Fitter::aim(const Case& c, Aim at) {
  fitted_.layers.clear();
  limit_ = may_need_faces(fitted_.light) ? widest_tangent : no_limit;
  // A stable fit must not turn with what the camera sees.
  const bool tight = params_.fit == Fit::tight;
  const Box& box = tight ? sample_box_ : c.frame->geometry.bounds;
  const Vec3d from = fitted_.light.towards.xyz();
  const Vec3d forward = !may_need_faces(fitted_.light) ? fitted_.light.axis
                        : at == Aim::center            ? Vec3d(box.center()) - from
                                                       : middle_direction(from, box);
  // Nor may stable ranges follow every sample that comes nearer or goes farther.
  const double lo = tight ? view_lo_ : 1 / rounded_up(1 / view_lo_);
  const double hi = tight ? view_hi_ : rounded_up(view_hi_);
  fitted_.splits =
      split_depths(params_.cascade_split, double(params_.cascade_lambda), params_.cascades, lo, hi);
  for (std::size_t i = 0; i + 1 < fitted_.splits.size(); ++i) {
    add_layer(light_frame(forward, tight ? c.frame->camera.basis().forward : fixed_hint));
    FittedLayer& layer = fitted_.layers.back();
    if (i > 0) layer.view_lo = fitted_.splits[i];
    if (i + 2 < fitted_.splits.size()) layer.view_hi = fitted_.splits[i + 1];
    if (params_.warp == Warp::none) continue;
    const auto aligned =
        view_aligned(fitted_.light, forward, c.frame->camera, fitted_.splits[i], fitted_.splits[i + 1]);
    if (!aligned) continue;
    layer.frame = *aligned, layer.warped = true;
    layer.space_from_world = light_from_world(fitted_.light, layer.frame);
  }
}

void Fitter::aim_faces() {
  fitted_.six_faces = true, limit_ = face_tangent;
  fitted_.layers.clear();
  for (int face = 0; face < 6; ++face) add_layer(cube_frame(face));
}

void Fitter::query(int slot, const Mat4d& space, double view_lo, double view_hi, double limit) {
  queries_.view<FitQuery>()[static_cast<std::size_t>(slot)] = {
      to_float(space),
      fitted_.light.device_towards(),
      fitted_.light.device_emission(),
      {static_cast<float>(view_lo), static_cast<float>(view_hi), static_cast<float>(limit), 0}};
}

void Fitter::query_layers() {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    const FittedLayer& l = fitted_.layers[i];
    query(static_cast<int>(i), l.space_from_world, l.view_lo, l.view_hi, limit_);
  }
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
  passes.finish();
}

bool Fitter::outside() const {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i)
    if (!decode(read_back_.view<SampleBounds>()[i]).whole) return true;
  return false;
}

void Fitter::cover_samples(const Case& c) {
  const bool at_infinity = fitted_.light.at_infinity();
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    FittedLayer& layer = fitted_.layers[i];
    layer.extent = decode(read_back_.view<SampleBounds>()[i]);
    layer.used = !layer.extent.empty();
    if (!layer.used) layer.extent.extend({0, 0, -1}), layer.extent.extend({1, 1, -0.5});
    if (params_.filter == Filter::pcss) {
      // Blockers' true depths are averaged: the near plane lies before all of them, not before the view
      // samples.
      double nearest = INFINITY;
      for_each_corner(c.frame->geometry.bounds, [&](Vec3d p) {
        nearest = std::min(nearest, dot(layer.frame.forward, p - fitted_.light.towards.xyz()));
      });
      const double first = -1 / layer.extent.lo.z;
      layer.extent.lo.z = -1 / std::clamp(nearest, 1e-3 * first, first);
    }
    const double lo = at_infinity ? layer.extent.lo.z : -1 / layer.extent.lo.z;
    const double hi = at_infinity ? layer.extent.hi.z : -1 / layer.extent.hi.z;
    const double room =
        std::max(0.02 * (hi - lo), least_depth_share * double(c.frame->geometry.bounds.diagonal()));
    layer.linear_lo = lo - room, layer.linear_hi = hi + room;
    if (layer.used && params_.fit == Fit::stable)
      layer.extent = snapped(layer.extent, params_.map_size, params_.border_texels());
  }
}

void Fitter::plan_warps(const Case& c) {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    FittedLayer& layer = fitted_.layers[i];
    unwarped_[i] = layer.space_from_world;
    if (!layer.warped || !layer.used) continue;
    const WarpInput in{layer.space_from_world,
                       fitted_.light,
                       layer.extent,
                       c.frame->camera,
                       c.width,
                       c.height,
                       least_depth_share * double(c.frame->geometry.bounds.diagonal())};
    const std::optional<Mat4d> w =
        warp(params_.warp, in, double(params_.lispsm_n), double(params_.tsm_focus));
    layer.warped = w.has_value();
    if (w) layer.space_from_world = *w * layer.space_from_world;
  }
  if (params_.warp == Warp::none) return;
  limit_ = no_limit;  // a warp's image plane is its own
  query_layers();
}

// Where a view sample turns out to lie behind a warp's centre, that map falls back to none.
void Fitter::cover_warped() {
  for (std::size_t i = 0; i < fitted_.layers.size(); ++i) {
    FittedLayer& layer = fitted_.layers[i];
    if (!layer.warped) continue;
    const Extent e = decode(read_back_.view<SampleBounds>()[i]);
    if (e.empty() || !e.whole) {
      layer.warped = false, layer.space_from_world = unwarped_[i];
      continue;
    }
    layer.extent = e;
  }
}

void Fitter::crop_layers(const Case& c) {
  const double diagonal = double(c.frame->geometry.bounds.diagonal());
  for (FittedLayer& layer : fitted_.layers) {
    const Extent& e = layer.extent;
    const bool plain = fitted_.light.at_infinity() && !layer.warped;
    const double least =
        plain ? least_depth_share * diagonal : 1e-3 * std::max(std::abs(e.lo.z), std::abs(e.hi.z));
    Mat4d m = crop(e, params_.map_size, params_.border_texels(), least);
    if (layer.warped && params_.warp == Warp::log) {
      // -1 / y is the distance v from the warp's centre; its logarithm fills the map as crop() would.
      const double inner = inner_share(params_.map_size, params_.border_texels());
      const double v0 = -1 / e.lo.y, v1 = std::max(-1 / e.hi.y, v0 * (1 + 1e-6));
      layer.log.scale = 2 * inner / std::log(v1 / v0);
      layer.log.offset = -inner - layer.log.scale * std::log(v0);
      m[1][1] = 1, m[3][1] = 0;
    }
    layer.clip_from_world = m * layer.space_from_world;
  }
}

// No fitting: the map covers the scene's bounds, or a spot's cone.
void Fitter::fit_scene(const Case& c) {
  aim(c, Aim::center);
  const Box& box = c.frame->geometry.bounds;
  double farthest = 0;
  for_each_corner(box,
                  [&](Vec3d p) { farthest = std::max(farthest, length(p - fitted_.light.towards.xyz())); });
  std::optional<Extent> whole = extent_of(box, fitted_.layers[0].space_from_world, limit_);
  if (!whole && may_need_faces(fitted_.light)) {
    aim(c, Aim::middle);
    whole = extent_of(box, fitted_.layers[0].space_from_world, limit_);
  }
  if (whole && !fitted_.light.spot) {
    fitted_.layers[0].extent = *whole;
  } else {
    if (!fitted_.light.spot) aim_faces();
    const double tangent = fitted_.six_faces ? face_tangent : fitted_.light.cone_tangent();
    for (FittedLayer& layer : fitted_.layers) {
      // Depth clamp keeps what is nearer than the near plane.
      layer.extent.extend({-tangent, -tangent, -1 / (1e-3 * farthest)});
      layer.extent.extend({tangent, tangent, -1 / farthest});
    }
  }
  for (FittedLayer& layer : fitted_.layers) {
    const Extent& e = layer.extent;
    const bool at_infinity = fitted_.light.at_infinity();
    const double room = least_depth_share * double(box.diagonal());
    layer.linear_lo = (at_infinity ? e.lo.z : -1 / e.lo.z) - room;
    layer.linear_hi = (at_infinity ? e.hi.z : -1 / e.hi.z) + room;
  }
}

}  // namespace penumbra::shadow_map
