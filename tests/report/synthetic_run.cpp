#include "synthetic_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "core/error.h"
#include "core/vec.h"
#include "image/image.h"

namespace penumbra::test {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

struct Sphere {
  Vec3f center;
  float radius;
};
using Spheres = std::vector<Sphere>;

float hit(Vec3f origin, Vec3f direction, const Sphere& s) {
  const Vec3f oc = origin - s.center;
  const float a = dot(direction, direction), b = dot(oc, direction), c = dot(oc, oc) - s.radius * s.radius;
  const float d = b * b - a * c;
  if (d < 0) return INFINITY;
  const float t = (-b - std::sqrt(d)) / a;
  return t > 1e-3f ? t : INFINITY;
}

struct Surface {
  bool there = false;
  Vec3f position, normal;
};

Surface view_sample(const Spheres& spheres, float u, float v) {
  const Vec3f eye{0, 2.4f, 3.4f};
  const Vec3f direction = normalize(Vec3f{.55f * u, -.55f - .55f * v, -1.f});
  float nearest = direction.y < 0 ? -eye.y / direction.y : INFINITY;
  Vec3f normal{0, 1, 0};
  for (const Sphere& s : spheres)
    if (const float t = hit(eye, direction, s); t < nearest) {
      nearest = t;
      normal = normalize(eye + direction * t - s.center);
    }
  if (nearest > 30) return {};
  const Vec3f position = eye + direction * nearest;
  return {true, position + normal * 1e-3f, normal};
}

float visibility(const Spheres& spheres, const Surface& at, int k, float light_size) {
  int lit = 0;
  for (int i = 0; i < k * k; ++i) {
    const float x = (static_cast<float>(i % k) + .5f) / static_cast<float>(k) - .5f;
    const float z = (static_cast<float>(i / k) + .5f) / static_cast<float>(k) - .5f;
    const Vec3f d = Vec3f{1.2f + light_size * x, 4, 1 + light_size * z} - at.position;
    const bool blocked =
        dot(at.normal, d) <= 0 || std::any_of(spheres.begin(), spheres.end(),
                                              [&](const Sphere& s) { return hit(at.position, d, s) < 1; });
    lit += !blocked;
  }
  return static_cast<float>(lit) / static_cast<float>(k * k);
}

// A picture of V, one float per pixel, 1 where nothing is seen; `snap` > 0 moves samples to a coarse grid as
// a shadow map's texels do.
std::vector<float> render(const SyntheticRun& o, const Spheres& spheres, int k, float light_size,
                          float snap) {
  std::vector<float> v(static_cast<std::size_t>(o.width * o.height), 1.f);
  for (int y = 0; y < o.height; ++y)
    for (int x = 0; x < o.width; ++x) {
      const float w = static_cast<float>(o.width), h = static_cast<float>(o.height);
      Surface at = view_sample(spheres, (2 * static_cast<float>(x) + 1 - w) / h,
                               (2 * static_cast<float>(y) + 1 - h) / h);
      if (!at.there) continue;
      if (snap > 0)
        at.position = {std::round(at.position.x / snap) * snap, at.position.y,
                       std::round(at.position.z / snap) * snap};
      v[static_cast<std::size_t>(y * o.width + x)] = visibility(spheres, at, k, light_size);
    }
  return v;
}

void write_pictures(const fs::path& run, const std::string& folder, const SyntheticRun& o,
                    const Spheres& spheres, const std::vector<float>& v) {
  fs::create_directories(run / folder);
  write_exr_gray(run / folder / "visibility.exr", o.width, o.height, v);
  std::vector<Vec3f> shaded(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const float w = static_cast<float>(o.width), h = static_cast<float>(o.height);
    const float x = static_cast<float>(i % static_cast<std::size_t>(o.width)),
                y = static_cast<float>(i / static_cast<std::size_t>(o.width));
    const Surface at = view_sample(spheres, (2 * x + 1 - w) / h, (2 * y + 1 - h) / h);
    shaded[i] = at.there ? Vec3f{.8f, .78f, .74f} *
                               ((.25f + .75f * std::max(0.f, at.normal.y)) * (.08f + .92f * v[i]))
                         : Vec3f{.5f, .55f, .6f};
  }
  write_png(run / folder / "shaded.png", tonemap(shaded, o.width, o.height));
}

json stat(double median, std::mt19937& random) {
  std::vector<double> samples(7);
  std::normal_distribution<double> noise(0, 0.02);
  for (double& s : samples) s = median * std::exp(noise(random));
  std::sort(samples.begin(), samples.end());
  double mean = 0;
  for (const double s : samples) mean += s / 7;
  return {{"median", samples[3]},
          {"mean", mean},
          {"min", samples[0]},
          {"p95", samples[6]},
          {"ci95", {samples[1], samples[5]}},
          {"samples", samples}};
}

json metrics(const std::vector<float>& reference, const std::vector<float>& test) {
  double absolute = 0, square = 0, bias = 0, greatest = 0;
  for (std::size_t i = 0; i < test.size(); ++i) {
    const double e = static_cast<double>(test[i]) - static_cast<double>(reference[i]),
                 n = static_cast<double>(test.size());
    absolute += std::abs(e) / n, square += e * e / n, bias += e / n,
        greatest = std::max(greatest, std::abs(e));
  }
  const json psnr = square > 0 ? json(-10 * std::log10(square)) : json();
  return {{"mae", absolute},
          {"rmse", std::sqrt(square)},
          {"max", greatest},
          {"psnr", psnr},
          {"ssim", 1 - 3 * absolute},
          {"flip", 0.7 * absolute},
          {"bias", bias},
          {"acne", 0.0},
          {"leak", nullptr},
          {"evaluated_pixels", test.size()},
          {"reference_standard_error", 2e-4},
          {"zones",
           {{"umbra", {{"pixels", 900}, {"mae", 0.0}, {"bias", 0.0}}},
            {"penumbra", {{"pixels", 2100}, {"mae", 3 * absolute}, {"bias", bias}}},
            {"lit", {{"pixels", 9000}, {"mae", absolute / 4}, {"bias", bias}}}}}};
}

json header(const std::string& name, const json& scenes) {
  return {
      {"schema_version", 1},
      {"config", {{"name", name}, {"reference", {{"light_samples", 1024}}}}},
      {"program", {{"version", "0.1.0"}, {"commit", "0123abcd"}, {"compiler", "GNU 12.2.0"}}},
      {"cpu", {{"model", "AMD EPYC 9B14"}, {"cores", 2}}},
      {"memory_bytes", 8ull << 30},
      {"os", {{"name", "Debian GNU/Linux 12 (bookworm)"}}},
      {"vulkan",
       {{"name", "llvmpipe (LLVM 15.0.6, 256 bits)"}, {"driver", "lavapipe"}, {"api_version", "1.3.230"}}},
      {"started", "2026-11-22T16:00:00Z"},
      {"load", {0.4, 0.5, 0.3}},
      {"scenes", scenes}};
}

json save(const fs::path& folder, const json& run, const json& points) {
  fs::create_directories(folder);
  const json results = {{"schema_version", 1}, {"run", run}, {"points", points}};
  std::ofstream(folder / "results.json") << results.dump();
  return results;
}

struct Variant {
  std::string technique;
  json params;
  int k;
  float snap;
  double ms;
};

std::vector<Variant> variants() {
  std::vector<Variant> list;
  for (const int k : {4, 8, 16}) {
    const double rays = k * k;
    list.push_back(
        {"ray_tracing", {{"mask_size", k}, {"dynamic", false}, {"robust", false}}, k, 0, 2 + 1.1 * rays});
    list.push_back(
        {"gears", {{"mask_size", k}, {"grid_size", 128}, {"assignment", "clusters"}}, k, 0, 40 + .55 * rays});
    list.push_back(
        {"gears", {{"mask_size", k}, {"grid_size", 128}, {"assignment", "triangles"}}, k, 0, 95 + .9 * rays});
  }
  for (const int size : {256, 1024, 4096})
    for (const int kernel : {1, 5})
      list.push_back({"shadow_map",
                      {{"map_size", size}, {"pcf_kernel", kernel}, {"fit", "tight"}},
                      kernel > 1 ? 3 : 1,
                      40.f / static_cast<float>(size),
                      4 + size * 0.01 + kernel});
  return list;
}

json point_of(const Variant& variant, const std::string& scene, int index, const SyntheticRun& o,
              std::mt19937& random) {
  json params = variant.params;
  params["resolution"] = {o.width, o.height};
  params["light"] = "key";
  params["camera"] = "front";
  params["light_size"] = 1.0;
  json point = {{"id", fmt::format("{:016x}", 0x9e3779b97f4a7c15ull * static_cast<unsigned>(index + 1))},
                {"technique", variant.technique},
                {"scene", scene},
                {"frame", 0},
                {"params", params},
                {"status", "ok"},
                {"command",
                 fmt::format("penumbra run configs/quick.json --filter '^{}/{}'", variant.technique, index)}};
  point["timing"] = {{"frame_ms", stat(variant.ms, random)},
                     {"build_ms", stat(12, random)},
                     {"passes",
                      {{"assign", stat(variant.ms * .2, random)},
                       {"mask", stat(variant.ms * .75, random)},
                       {"resolve", stat(variant.ms * .05, random)}}}};
  if (params.value("map_size", 0) == 256) {
    point["title"] = "Blocky <edges>";
    point["caption"] = "Texels are larger than pixels.";
  }
  point["memory"] = {
      {"device_bytes", 48 << 20}, {"host_peak_bytes", 190 << 20}, {"structure_bytes", 7340032}};
  point["counters"] = {{"triangles_per_cell_average", 41.5}, {"cells", {1, 4, 9, 16, 12, 5, 2, 0, 1}}};
  return point;
}

}  // namespace

json write_synthetic_run(const fs::path& folder, const SyntheticRun& o) {
  std::mt19937 random(1);
  const std::vector<std::pair<std::string, Spheres>> scenes = {
      {"ball", {{{0, .6f, 0}, .6f}}},
      {hostile_scene, {{{-.8f, .4f, .3f}, .4f}, {{.3f, .7f, -.5f}, .7f}, {{.9f, .25f, .7f}, .25f}}}};
  json points = json::array(), reports = json::array();
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const auto& [name, spheres] = scenes[s];
    reports.push_back({{"name", name},
                       {"triangles", 69666},
                       {"view_samples_ms", 3.2},
                       {"meshes",
                        {json{{"name", "ball"}, {"closed", true}, {"open_edges", 0}},
                         json{{"name", "plane"}, {"closed", false}, {"open_edges", 4}}}}});
    const std::string truth_folder = fmt::format("images/reference-{}", s);
    const std::vector<float> truth = render(o, spheres, 24, 1, 0);
    if (o.pictures) write_pictures(folder, truth_folder, o, spheres, truth);
    for (const Variant& variant : variants()) {
      json point = point_of(variant, name, static_cast<int>(points.size()), o, random);
      const std::vector<float> v = render(o, spheres, variant.k, 1, variant.snap);
      point["metrics"] = metrics(truth, v);
      if (variant.technique != "shadow_map")
        point["metrics_matched"] = {
            {"mae", 0.0}, {"max", 0.0}, {"pixels_off", 0.0}, {"mask_bit_mismatch", 3.1e-7}};
      if (o.pictures) {
        const std::string images = "images/" + point["id"].get<std::string>();
        write_pictures(folder, images, o, spheres, v);
        point["images"] = {{"visibility", images + "/visibility.exr"},
                           {"shaded", images + "/shaded.png"},
                           {"reference", truth_folder + "/visibility.exr"},
                           {"reference_shaded", truth_folder + "/shaded.png"}};
      }
      points.push_back(point);
    }
  }
  for (const char* status : {"unsupported", "failed"}) {
    json point = point_of({"soft_shadow_volume", {{"split", 1}}, 1, 0, 1}, "ball",
                          static_cast<int>(points.size()), o, random);
    for (const char* key : {"timing", "memory", "counters"}) point.erase(key);
    point["status"] = status;
    point["message"] = std::string(status) == "failed"
                           ? "out of memory</script><script>window.hacked=1</script>"
                           : "The mesh has 223 open edges; penumbra wedges need closed meshes.";
    points.push_back(point);
  }
  return save(folder, header("synthetic", reports), points);
}

json write_moving_run(const fs::path& folder, int frames) {
  const json still = write_synthetic_run(folder);
  json points = json::array();
  for (std::size_t variant = 0; variant < 2; ++variant)
    for (int frame = 0; frame < frames; ++frame) {
      json point = still["points"][variant];
      point["id"] = fmt::format("{}-{}", point["id"].get<std::string>(), frame);
      point["frame"] = frame;
      point["metrics"]["flicker"] = frame > 0 ? json(0.01 * frame) : json();
      if (variant == 0 && frame == 0) {
        point["images"]["diagnostic_lists"] = point["images"]["shaded"];
        point["images"]["diagnostic_zones"] = point["images"]["reference_shaded"];
        point["diagnostics"] = {json{{"name", "lists"},
                                     {"title", "Lists </script><script>window.hacked=1</script>"},
                                     {"kind", "figures"},
                                     {"high", 99.0},
                                     {"median", 3.0},
                                     {"above_none", 12},
                                     {"colors", {"#000000", "#ffff00"}},
                                     {"marks", {0, 2.2, 9, 31, 99}}},
                                json{{"name", "zones"},
                                     {"title", "Zones"},
                                     {"kind", "classes"},
                                     {"names", {"umbra", "penumbra"}},
                                     {"colors", {"#0000ff", "#ff0000"}},
                                     {"pixels", {5, 7}}}};
      }
      points.push_back(std::move(point));
    }
  return save(folder, header("moving", json::array()), points);
}

json write_large_run(const fs::path& folder, int count) {
  std::mt19937 random(2);
  SyntheticRun o;
  json points = json::array();
  const std::vector<float> one(16, 1.f), half(16, .5f);
  const std::vector<std::string> techniques = {"ray_tracing", "gears", "shadow_map", "line_space"};
  for (int i = 0; i < count; ++i) {
    const Variant variant{
        techniques[static_cast<std::size_t>(i % 4)],
        {{"mask_size", 4 << (i / 4 % 4)}, {"grid_size", 32 << (i / 16 % 4)}, {"light_size", .1 * (i / 64)}},
        1,
        0,
        10 + i * .01};
    json point = point_of(variant, fmt::format("scene{}", i / 64 % 3), i, o, random);
    point["metrics"] = metrics(one, half);
    points.push_back(std::move(point));
  }
  return save(folder, header("large", json::array()), points);
}

}  // namespace penumbra::test
