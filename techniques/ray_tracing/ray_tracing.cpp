#include "techniques/ray_tracing/ray_tracing.h"

#include "techniques/common/embree_hierarchy.h"
#include "techniques/common/exact_choice.h"
#include "techniques/ray_tracing/params.h"
#include "techniques/ray_tracing/tracer.h"

namespace penumbra {
namespace {

using Hierarchy = EmbreeHierarchy;
using Quality = HierarchyQuality;
using ray_tracing::trace_settings;
using ray_tracing::Tracer;
using ray_tracing::TraceSettings;

Quality quality_of(const RayTracingParams& p) {
  switch (p.build_quality) {
    case RayTracingParams::BuildQuality::automatic:
      return p.dynamic ? Quality::medium : Quality::high;
    case RayTracingParams::BuildQuality::low:
      return Quality::low;
    case RayTracingParams::BuildQuality::medium:
      return Quality::medium;
    case RayTracingParams::BuildQuality::high:
      return Quality::high;
    case RayTracingParams::BuildQuality::refit:
      break;
  }
  return Quality::refit;
}

class RayTracing final : public Technique {
 public:
  explicit RayTracing(const RayTracingParams& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (c.frame->geometry.triangle_count() == 0) return "The scene has no triangle.";
    return std::nullopt;
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Frame& frame = *c.frame;
    // A dynamic point is asked to build every frame, also where nothing has moved: then, too, it only takes
    // the vertices anew. It never sees another scene, so a hierarchy of the same size is the same topology.
    const bool same = hierarchy_ && hierarchy_->fits(frame.geometry);
    if (!same || (frame.changes.topology && !params_.dynamic)) {
      passes.host_pass("copy_geometry", [&] { load(frame.geometry); });
      passes.host_pass("build_hierarchy", [&] { hierarchy_->commit(); });
    } else if (frame.changes.positions || params_.dynamic) {
      passes.host_pass("copy_vertices", [&] { hierarchy_->move(frame.geometry); });
      passes.host_pass(refits() ? "refit_hierarchy" : "build_hierarchy", [&] { hierarchy_->commit(); });
    }
    passes.host_pass("order_light_samples",
                     [&] { tracer_.assign(frame.light, *c.light_samples, settings_for(c)); });
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    struct Call {
      RayTracing& self;
      const RenderInput& in;
    } const call{*this, in};
    passes.host_pass("trace", [&call] {
      const RenderInput& i = call.in;
      call.self.counts_ = call.self.tracer_.trace(call.self.hierarchy_->scene(), i.view_samples->host(),
                                                  i.host.visibility, i.host.mask);
    });
  }

  Counters counters() override {
    return {{"rays", static_cast<double>(counts_.rays)},
            {"light_samples_without_ray", static_cast<double>(counts_.without_ray)},
            {"packet", static_cast<double>(tracer_.settings().packet)},
            {"coherent", tracer_.settings().coherence == embree::Coherence::coherent ? 1.0 : 0.0},
            {"bvh_bytes", hierarchy_ ? static_cast<double>(hierarchy_->bytes()) : 0.0}};
  }

  uint64_t structure_bytes() const override {
    return (hierarchy_ ? hierarchy_->bytes() : 0) + tracer_.bytes();
  }

 private:
  TraceSettings settings_for(const Case& c) const {
    return trace_settings(params_, c.frame->geometry.triangle_count(), c.light_samples->count(),
                          hierarchy_->native_packet());
  }

  bool refits() const { return quality_of(params_) == Quality::refit; }

  void load(const Geometry& geometry) {
    hierarchy_ = std::make_unique<Hierarchy>(quality_of(params_), params_.dynamic, params_.robust);
    hierarchy_->load(geometry);
  }

  RayTracingParams params_;
  std::unique_ptr<Hierarchy> hierarchy_;
  Tracer tracer_;
  ray_tracing::TraceCounts counts_;
};

}  // namespace

TechniqueInfo ray_tracing_technique() {
  TechniqueInfo info;
  info.name = "ray_tracing";
  info.title = "Ray tracing with Embree";
  info.sources = {"Wald2014"};
  info.params = ray_tracing_params().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.choosing = exact_choice_in_words();
  info.sampled = true;
  info.rotates = true;
  info.residence = Residence::host;
  info.rebuild_each_frame = [](const ParamValues& values) {
    return ray_tracing_params().read(values).dynamic;
  };
  info.make = [](const ParamValues& values) -> std::unique_ptr<Technique> {
    return std::make_unique<RayTracing>(ray_tracing_params().read(values));
  };
  return info;
}

}  // namespace penumbra
