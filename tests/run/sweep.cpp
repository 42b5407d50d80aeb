#include "tests/run/sweep.h"

#include <cstdlib>

#include "run/files.h"

namespace penumbra::test {

Sweep::Sweep() {
  write_scene("still", "");
  write_scene("moving", R"(, "animation": { "instances": [ { "instance": "box", "keyframes": [
    { "frame": 0 }, { "frame": 10, "translate": [1, 0, 0] } ] } ] })");
  plan.name = "test";
  plan.reference_samples = 16;
  plan.images = {};
  plan.measure = {1, 3, 0, 5};
  plan.expanded_config = "{}";
  options.out = out();
  options.quiet = true;
  options.limit_grace_s = 0.3;
  options.worker.scene_search = {folder_.path()};
  options.worker_command = {std::filesystem::read_symlink("/proc/self/exe").string(), "worker"};
  ::setenv("PENUMBRA_TEST_LOG", (folder_ / "frames.log").c_str(), 1);
}

void Sweep::write_scene(const std::string& name, const std::string& animation) const {
  run::write_text(folder_ / (name + ".json"), R"({ "name": ")" + name + R"(", "fidelity": "procedural",
    "meshes": { "ground": { "generator": "plane", "params": { "size_x": 8, "size_z": 8 } }, "box": { "generator": "box" } },
    "instances": [ { "mesh": "ground" }, { "name": "box", "mesh": "box", "transform": [ { "translate": [0, 1, 0] } ] } ],
    "lights": [ { "name": "key", "kind": "rectangle", "center": [1, 5, 1.5], "target": [0, 0, 0], "width": 1, "height": 1 },
                { "name": "sun", "kind": "directional", "direction": [0, -1, 0] } ],
    "cameras": [ { "name": "front", "eye": [0, 4, 6], "target": [0, 0, 0] } ])" +
                                                  animation + "}");
}

Sweep& Sweep::add(const ParamValues& given, int frame, const std::string& scene) {
  Point p;
  p.id = "p" + std::to_string(plan.points.size());
  p.technique = "fake";
  p.params = resolve(fake_technique().params, given, "test");
  p.scene = scene;
  p.light = "key";
  p.camera = "front";
  p.width = 40;
  p.height = 30;
  p.light_samples.width = p.light_samples.height = 2;
  p.sampled = true;
  p.frame = frame;
  plan.points.push_back(p);
  return *this;
}

run::RunOutcome Sweep::run(bool resume) {
  options.resume = resume;
  return run::run_plan(plan, options, fake_registry());
}

nlohmann::json Sweep::results() const {
  return nlohmann::json::parse(run::read_text(out() / "results.json"));
}

nlohmann::json Sweep::record(const std::string& id) const {
  const nlohmann::json all = results();
  for (const auto& point : all.at("points"))
    if (point.at("id") == id) return point;
  return nullptr;
}

int Sweep::frames_begun(double value) const {
  std::ifstream log(folder_ / "frames.log");
  int n = 0;
  for (double v; log >> v;) n += v == value;
  return n;
}

}  // namespace penumbra::test
