#include "run/run_file.h"

#include "core/parallel.h"
#include "run/files.h"
#include "run/provenance.h"
#include "run/record.h"
#include "run/view.h"

namespace penumbra::run {
namespace {

nlohmann::json former_run(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return nlohmann::json::object();
  auto json = nlohmann::json::parse(read_text(path), nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

}  // namespace

RunFile::RunFile(std::filesystem::path path, const Plan& plan, const RunOptions& options)
    : path_(std::move(path)), json_(provenance()), start_(now_s()) {
  json_["schema_version"] = schema_version;
  json_["name"] = plan.name;
  json_["config"] = nlohmann::json::parse(plan.expanded_config, nullptr, false);
  if (json_["config"].is_discarded()) json_["config"] = nullptr;
  json_["command_line"] = options.command_line;
  json_["points"] = plan.points.size();
  if (!options.shard.empty()) json_["shard"] = options.shard;
  json_["scenes"] = nlohmann::json::array();
  json_["cost_s"] = nlohmann::json::object();
  json_["complete"] = false;
  if (!options.resume) return;
  const nlohmann::json former = former_run(path_);
  json_["scenes"] = former.value("scenes", nlohmann::json::array());
  json_["former_starts"] = former.value("former_starts", nlohmann::json::array());
  if (former.contains("started")) json_["former_starts"].push_back(former["started"]);
}

void RunFile::set_device(const nlohmann::json& hello) {
  const bool first = !device_known();
  json_["vulkan"] = hello.at("device");
  json_["clock"] = hello.at("device").at("clock");
  json_["threads"] = hello.at("threads");
  if (first) write();
}

nlohmann::json* RunFile::scene_entry(const std::string& name) {
  for (auto& scene : json_["scenes"])
    if (scene.value("name", "") == name) return &scene;
  return nullptr;
}

void RunFile::add_scene(const nlohmann::json& scene) {
  nlohmann::json entry = scene;
  entry.erase("event");
  if (nlohmann::json* known = scene_entry(entry.at("name"))) {
    if (known->value("content_hash", nlohmann::json()) == entry.at("content_hash")) return;
    *known = entry;
  } else {
    json_["scenes"].push_back(entry);
  }
  write();
}

void RunFile::add_view(const nlohmann::json& view) {
  nlohmann::json* scene = scene_entry(view.at("scene"));
  if (!scene) return;
  nlohmann::json entry = view;
  entry.erase("event");
  entry.erase("scene");
  nlohmann::json& views = (*scene)["views"];
  if (!views.is_array()) views = nlohmann::json::array();
  for (auto& v : views)
    if (v["camera"] == entry["camera"] && v["resolution"] == entry["resolution"] &&
        v["frame"] == entry["frame"]) {
      v = entry;
      return;
    }
  views.push_back(entry);
  // The scene's own figure is its first view's; the others stand beside it.
  (*scene)["view_samples_ms"] = views[0]["view_samples_ms"];
}

void RunFile::add_costs(const nlohmann::json& costs) {
  for (const auto& [name, seconds] : costs.items())
    json_["cost_s"][name] = json_["cost_s"].value(name, 0.0) + seconds.get<double>();
}

// "harness" is what is left of the wall time: neither techniques (with their counters), references nor
// pictures. An interrupted worker has not told what it spent, which would all be the harness's then: no
// figure.
void RunFile::finish(bool complete, std::size_t points) {
  json_["points"] = points;
  const double wall = now_s() - start_;
  nlohmann::json& costs = json_["cost_s"];
  double accounted = 0;
  for (const char* entry : {"technique", "counters", "references", "images"})
    accounted += costs.value(entry, 0.0);
  costs["wall"] = wall;
  if (complete)
    costs["harness"] = wall - accounted;
  else
    costs.erase("harness");
  json_["complete"] = complete;
  json_["ended"] = utc_time();
  json_["load_at_end"] = load_average();
  write();
}

void RunFile::write() const {
  write_text(path_, json_.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace penumbra::run
