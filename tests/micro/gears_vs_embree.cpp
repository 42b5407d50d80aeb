// gears, all its per-frame stages, against Embree's fastest packets in one run, on the study's scenes:
//   micro_gears_vs_embree [SCENE ...] [key=value ...] [--benchmark_repetitions=5]
//   [--benchmark_enable_random_interleaving=true]
// Scenes are names under configs/scenes (the eight study_* scenes that are there by default); key=value are
// parameters of gears, or k=16,32 and resolution=512. The opponent is ray_tracing, not robust, with packets
// of 8 and 16 rays and both coherence hints: the fastest of the four counts. The table ends with the ratio of
// the medians.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "techniques/registry.h"
#include "tests/techniques/gears_render.h"

namespace penumbra {
namespace {

using testing::DeviceScene;
using testing::GearsRun;

// Milliseconds of all passes since the last call.
double taken(gpu::PassRecorder& passes) {
  double ms = 0;
  for (const gpu::PassTime& p : passes.take_times()) ms += p.ms;
  return ms;
}

struct Embree {
  DeviceScene& scene;
  std::unique_ptr<Technique> technique;
  std::vector<float> visibility;
  std::vector<uint32_t> mask;

  Embree(DeviceScene& scene_, const char* packet, const char* coherent) : scene(scene_) {
    const Registry registry = all_techniques();
    const TechniqueInfo& info = find_technique(registry, "ray_tracing");
    technique = info.make(resolve(
        info.params, {{"packet", std::string(packet)}, {"coherent", std::string(coherent)}}, "ray_tracing"));
    visibility.resize(scene.view->host().pixel_count());
    mask.resize(visibility.size() * static_cast<std::size_t>(scene.samples.mask_words()));
    technique->build(scene.scene_case, scene.passes);
    scene.passes.finish();
  }
  void render() {
    RenderInput in;
    in.scene_case = &scene.scene_case;
    in.view_samples = scene.view.get();
    in.host = {visibility, mask};
    technique->render(in, scene.passes);
    scene.passes.finish();
  }
};

// One frame per iteration, by the passes' own clock.
template <class Renderer>
void measure(benchmark::State& state, DeviceScene& scene, Renderer& renderer) {
  renderer.render();
  taken(scene.passes);
  for ([[maybe_unused]] auto _ : state) {
    renderer.render();
    state.SetIterationTime(taken(scene.passes) / 1000);
  }
}

struct Options {
  std::vector<std::string> scenes;
  std::vector<int> k = {16, 32};
  int resolution = 512;
  ParamValues gears;
};

// Everything for one scene and mask size, made on first use: the dragons are large.
struct Contest {
  std::unique_ptr<DeviceScene> scene;
  std::map<std::string, std::unique_ptr<Embree>> embree;
  std::unique_ptr<GearsRun> gears;
};

void add(gpu::Device& device, const Options& options, const std::string& name, int k, Contest& contest) {
  const auto scene = [&device, &options, name, k, &contest]() -> DeviceScene& {
    if (!contest.scene)
      contest.scene =
          std::make_unique<DeviceScene>(device, Scene::load(name, {"configs/scenes"}).frame(0, "", "", -1),
                                        options.resolution, options.resolution, LightSampleRequest{k, k});
    return *contest.scene;
  };
  const std::string of = fmt::format("{}/k:{}/", name, k);
  const auto add_one = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((of + what).c_str(), run)->UseManualTime()->Unit(benchmark::kMillisecond);
  };
  for (const char* packet : {"8", "16"})
    for (const char* coherent : {"on", "off"})
      add_one(fmt::format("embree_{}_coherent_{}", packet, coherent), [=, &contest](benchmark::State& s) {
        auto& e = contest.embree[fmt::format("{}{}", packet, coherent)];
        if (!e) e = std::make_unique<Embree>(scene(), packet, coherent);
        measure(s, scene(), *e);
      });
  add_one("gears", [=, &contest, &options](benchmark::State& s) {
    if (!contest.gears) contest.gears = std::make_unique<GearsRun>(scene(), options.gears);
    measure(s, scene(), *contest.gears);
  });
}

// Prints as usual, and keeps the times for the closing ratios.
class Ratios : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[run.run_name.function_name].push_back(run.GetAdjustedRealTime());
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    std::map<std::string, std::pair<double, double>> best;  // scene and k: Embree, gears
    for (auto& [name, times] : times_) {
      std::ranges::sort(times);
      const double median = times[times.size() / 2];
      const std::size_t slash = name.rfind('/');
      auto& [embree, gears] = best.try_emplace(name.substr(0, slash), INFINITY, INFINITY).first->second;
      double& slot = name.substr(slash + 1) == "gears" ? gears : embree;
      slot = std::min(slot, median);
    }
    for (const auto& [name, times] : best)
      fmt::print("{}: embree {:.0f} ms, gears {:.0f} ms: {:.2f} times as fast\n", name, times.first,
                 times.second, times.first / times.second);
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

Options read(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const std::size_t equals = arg.find('=');
    if (equals == std::string::npos) {
      o.scenes.push_back(arg);
      continue;
    }
    const std::string key = arg.substr(0, equals), value = arg.substr(equals + 1);
    if (key == "k") {
      o.k.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) o.k.push_back(std::stoi(one));
    } else if (key == "resolution") {
      o.resolution = std::stoi(value);
    } else if (!value.empty() && value.find_first_not_of("0123456789") == std::string::npos) {
      o.gears[key] = int64_t{std::stoll(value)};
    } else if (!value.empty() && value.find_first_not_of("0123456789.") == std::string::npos) {
      o.gears[key] = std::stod(value);
    } else {
      o.gears[key] = value;
    }
  }
  if (o.scenes.empty())
    o.scenes = {"study_city", "study_dragon4", "study_dragon3", "study_knots",  "study_bunny",
                "study_nest", "study_dragon2", "study_hair",    "study_dragon1"};
  return o;
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
  using namespace penumbra;
  benchmark::Initialize(&argc, argv);
  try {
    const Options options = read(argc, argv);
    gpu::Device device{gpu::DeviceOptions{}};
    std::map<std::string, Contest> contests;
    for (const std::string& name : options.scenes) {
      try {
        Scene::load(name, {"configs/scenes"});
      } catch (const InputError& e) {
        fmt::print(stderr, "left out: {}\n", e.what());
        continue;
      }
      for (const int k : options.k) add(device, options, name, k, contests[fmt::format("{}/{}", name, k)]);
    }
    Ratios reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}
