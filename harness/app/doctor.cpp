// What this machine offers, and what each technique would lack on it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "app/commands.h"
#include "core/error.h"
#include "core/parallel.h"
#include "gpu/device.h"
#include "scene/generators.h"

namespace penumbra {
namespace {

using nlohmann::json;

// The smallest case that shows what a technique needs: a closed box under a light.
Frame probe_frame(LightKind kind) {
  Frame frame;
  Mesh mesh = generate("box", {});
  clean(mesh, "box");
  Geometry& g = frame.geometry;
  g.positions = mesh.positions, g.normals = mesh.normals, g.indices = mesh.indices;
  g.triangle_instance.assign(mesh.triangle_count(), 0);
  g.instance_albedo = {{0.75f, 0.75f, 0.75f}};
  g.instance_closed = {1};
  g.closed = true;
  for (const Vec3f p : g.positions) g.bounds.extend(p);
  Light& light = frame.light;
  light.kind = kind;
  light.name = "probe";
  light.center = {0, 4, 0};
  light.edge_u = {1, 0, 0}, light.edge_v = {0, 0, 1}, light.radius = 0.5f;
  light.texture_width = light.texture_height = 1;
  light.weights = {1};
  light.points = {{0, 4, 0}};
  return frame;
}

ParamValues defaults(const TechniqueInfo& info) { return resolve(info.params, {}, info.name); }

// Why the technique cannot do such a light here with default parameters; empty when it can.
std::string lacks(const TechniqueInfo& info, LightKind kind, gpu::Device& device) {
  try {
    const Frame frame = probe_frame(kind);
    gpu::PassRecorder passes(device);
    GeometryOnDevice geometry;
    geometry.update(device, frame, passes);
    passes.finish();
    const LightSamples samples = make_light_samples(frame.light, {});
    const Case c{&device, &frame, &geometry, &samples, 64, 64};
    return info.make(defaults(info))->supports(c).value_or("");
  } catch (const std::exception& e) {
    return e.what();
  }
}

json capabilities(const gpu::Device& device) {
  const gpu::Capabilities& c = device.caps();
  return {{"subgroup_size", c.subgroup_size},
          {"max_storage_buffer_range", c.max_storage_buffer_range},
          {"max_allocation", c.max_allocation},
          {"heap_bytes", c.heap_bytes},
          {"max_image_2d", c.max_image_2d},
          {"max_workgroups_x", c.max_workgroups_x},
          {"conservative_rasterization", c.conservative_rasterization},
          {"geometry_shader", c.geometry_shader},
          {"fragment_stores", c.fragment_stores},
          {"logic_op", c.logic_op},
          {"depth_clamp", c.depth_clamp},
          {"int64", c.int64},
          {"unified_memory", c.unified_memory},
          {"timestamp_period_ns", c.timestamp_period_ns}};
}

json techniques(const Registry& registry, gpu::Device& device) {
  json out = json::object();
  for (const TechniqueInfo& info : registry)
    for (const LightKind kind : info.lights) out[info.name][to_string(kind)] = lacks(info, kind, device);
  return out;
}

json examine(const Context& context) {
  gpu::DeviceOptions options;
  options.select = context.device;
  gpu::Device device(options);
  const gpu::DeviceInfo& info = device.info();
  return {{"device",
           {{"name", info.name},
            {"index", info.index},
            {"driver", info.driver},
            {"driver_version", info.driver_version},
            {"api_version", info.api_version},
            {"software", info.software}}},
          {"clock", device.clock() == gpu::Device::Clock::timestamps ? "timestamps" : "submit_and_fence"},
          {"capabilities", capabilities(device)},
          {"host", {{"hardware_threads", std::thread::hardware_concurrency()}, {"threads", thread_count()}}},
          {"techniques", techniques(context.registry, device)}};
}

void print_text(const json& report) {
  const json& device = report["device"];
  const auto text = [](const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  fmt::print("Device      {} (index {}{})\n", text(device["name"]), text(device["index"]),
             device["software"].get<bool>() ? ", software" : "");
  fmt::print("Driver      {} {}, Vulkan {}\n", text(device["driver"]), text(device["driver_version"]),
             text(device["api_version"]));
  fmt::print("GPU time    by {}\n", report["clock"] == "timestamps"
                                        ? "the device's timestamps, which agree with the host"
                                        : "submit and fence: the device's timestamps are wrong");
  fmt::print("Threads     {} of {}\n", text(report["host"]["threads"]),
             text(report["host"]["hardware_threads"]));
  fmt::print("Limits and features\n");
  for (const auto& [name, value] : report["capabilities"].items())
    fmt::print("  {:<28} {}\n", name, text(value));
  fmt::print("Techniques\n");
  for (const auto& [name, lights] : report["techniques"].items())
    for (const auto& [light, reason] : lights.items())
      fmt::print("  {:<28} {:<20} {}\n", name, light, reason == "" ? "can run" : "lacks: " + text(reason));
}

}  // namespace

void add_doctor(CLI::App& app, Context& context) {
  auto as_json = std::make_shared<bool>(false);
  CLI::App* sub =
      app.add_subcommand("doctor", "Device, driver, limits, clock, and what each technique would lack here");
  sub->add_flag("--json", *as_json, "As a JSON object");
  sub->callback([as_json, &context] {
    const json report = examine(context);
    if (*as_json)
      fmt::print("{}\n", report.dump(2));
    else
      print_text(report);
  });
}

}  // namespace penumbra
