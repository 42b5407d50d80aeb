// The exact techniques that run on the host, all their per-frame stages, against Embree's fastest packets in
// one run, on the study's scenes, and what each stage takes:
//   micro_exact_vs_embree [SCENE ...] [k=16,32] [techniques=depth,clusters,triangles] [resolution=512]
//   [light_size=D] [dynamic=true] [soup=true] [quick=true] [packets=8,16] [avx2=true]
//   [--benchmark_repetitions=5] [--benchmark_enable_random_interleaving=true]
// techniques: depth_complexity_sampling, and gears with backend=cpu and either assignment; depth and clusters
// by default. Each stage's milliseconds are printed as counters; find_edges_once and order_triangles_once are
// made once for a topology, no part of a frame. Scenes are names under configs/scenes (the study_* scenes
// that are there by default). The opponent is ray_tracing, not robust, with packets of 8 and 16 rays and both
// coherence hints (dynamic: with its own choice of packet, at its low, medium and refitted build qualities):
// the fastest counts. light_size: the rectangle's diagonal. dynamic: all sides take the vertices anew each
// frame, and building counts. soup: each triangle shrunk by a thousandth, so that every edge is open. quick:
// one opponent, ray_tracing as it chooses for itself. packets: those of the opponent. avx2: the techniques,
// not Embree, without AVX-512. The table ends with the ratios of the medians.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "core/error.h"
#include "techniques/registry.h"
#include "tests/techniques/depth_complexity_render.h"

namespace penumbra {
namespace {

using testing::DeviceScene;

struct Options {
  std::vector<std::string> scenes;
  std::vector<int> k = {16, 32};
  std::vector<std::string> techniques = {"depth", "clusters"};
  int resolution = 512;
  float light_size = -1;
  bool dynamic = false, soup = false, quick = false, avx2 = false;
  std::vector<std::string> packets = {"8", "16"};
};

// A technique that runs on the host, with what its passes took since the last call.
struct HostRun {
  DeviceScene& scene;
  std::unique_ptr<Technique> technique;
  std::vector<float> visibility;
  std::vector<uint32_t> mask;
  std::map<std::string, double> passes;
  std::map<std::string, double> once;  // passes of the first build

  HostRun(DeviceScene& scene_, const std::string& name, const ParamValues& given) : scene(scene_) {
    const Registry registry = all_techniques();
    const TechniqueInfo& info = find_technique(registry, name);
    technique = info.make(resolve(info.params, given, name));
    visibility.resize(scene.view->host().pixel_count());
    mask.resize(visibility.size() * static_cast<std::size_t>(scene.samples.mask_words()));
    build();
    taken();
    for (const char* name_once : {"find_edges", "order_triangles"})
      if (passes.contains(name_once)) once[name_once] = passes[name_once];
  }
  void build() { technique->build(scene.scene_case, scene.passes); }
  void render() {
    RenderInput in;
    in.scene_case = &scene.scene_case, in.view_samples = scene.view.get(), in.host = {visibility, mask};
    technique->render(in, scene.passes);
  }
  double taken() {
    double ms = 0;
    for (const gpu::PassTime& p : scene.passes.take_times()) ms += p.ms, passes[p.name] += p.ms;
    return ms;
  }
};

void measure(benchmark::State& state, HostRun& run, bool dynamic) {
  run.render();
  run.taken();
  run.passes.clear();
  for ([[maybe_unused]] auto _ : state) {
    if (dynamic) run.build();
    run.render();
    state.SetIterationTime(run.taken() / 1000);
  }
  for (const auto& [name, ms] : run.once) state.counters[name + "_once"] = ms;
  for (const auto& [name, ms] : run.passes)
    state.counters[name] = benchmark::Counter(ms, benchmark::Counter::kAvgIterations);
}

// Everything for one scene and mask size, made on first use: the dragons are large.
struct Contest {
  std::unique_ptr<DeviceScene> scene;
  std::map<std::string, std::unique_ptr<HostRun>> runs;
};

std::unique_ptr<DeviceScene> load(gpu::Device& device, const Options& options, const std::string& name,
                                  int k) {
  Frame frame = Scene::load(name, {"configs/scenes"}).frame(0, "", "", options.light_size);
  if (options.soup) testing::make_soup(frame.geometry, 1e-3F);
  return std::make_unique<DeviceScene>(device, std::move(frame), options.resolution, options.resolution,
                                       LightSampleRequest{k, k});
}

void add(gpu::Device& device, const Options& options, const std::string& name, int k, Contest& contest) {
  const auto add_one = [&](const std::string& label, const std::string& technique,
                           const ParamValues& params) {
    const auto run = [=, &device, &options, &contest](benchmark::State& s) {
      if (!contest.scene) contest.scene = load(device, options, name, k);
      auto& r = contest.runs[label];
      if (!r) r = std::make_unique<HostRun>(*contest.scene, technique, params);
      measure(s, *r, options.dynamic);
    };
    benchmark::RegisterBenchmark(fmt::format("{}/k:{}/{}", name, k, label).c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  if (options.dynamic)
    for (const std::string quality : {"low", "medium", "refit"})
      add_one("embree_" + quality, "ray_tracing", {{"dynamic", true}, {"build_quality", quality}});
  else if (options.quick)
    add_one("embree", "ray_tracing", {});
  else
    for (const std::string& packet : options.packets)
      for (const std::string coherent : {"on", "off"})
        add_one("embree_" + packet + "_coherent_" + coherent, "ray_tracing",
                {{"packet", packet}, {"coherent", coherent}});
  for (const std::string& technique : options.techniques)
    if (technique == "depth")
      add_one("depth_complexity_sampling", "depth_complexity_sampling", {{"dynamic", options.dynamic}});
    else
      add_one("gears_cpu_" + technique, "gears",
              {{"backend", std::string("cpu")}, {"assignment", technique}});
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
    std::map<std::string, double> embree;                       // by scene and k
    std::map<std::string, std::map<std::string, double>> ours;  // and by technique
    for (auto& [name, times] : times_) {
      std::ranges::sort(times);
      const double median = times[times.size() / 2];
      const std::size_t slash = name.rfind('/');
      const std::string scene = name.substr(0, slash), label = name.substr(slash + 1);
      if (label.starts_with("embree")) {
        const double before = embree.contains(scene) ? embree[scene] : INFINITY;
        embree[scene] = std::min(before, median);
      } else {
        ours[scene][label] = median;
      }
    }
    for (const auto& [scene, by_technique] : ours)
      for (const auto& [label, ms] : by_technique)
        fmt::print("{}: embree {:.0f} ms, {} {:.1f} ms: {:.2f} times as fast\n", scene, embree[scene], label,
                   ms, embree[scene] / ms);
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

Options read(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const std::size_t equals = arg.find('=');
    const std::string key = arg.substr(0, equals),
                      value = equals == std::string::npos ? "" : arg.substr(equals + 1);
    if (equals == std::string::npos) {
      o.scenes.push_back(arg);
    } else if (key == "k") {
      o.k.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) o.k.push_back(std::stoi(one));
    } else if (key == "techniques") {
      o.techniques.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) {
        const std::vector<std::string> known = {"depth", "clusters", "triangles"};
        if (std::ranges::find(known, one) == known.end())
          throw InputError("Unknown technique '" + one + "'." + suggestion(one, known));
        o.techniques.push_back(one);
      }
    } else if (key == "resolution") {
      o.resolution = std::stoi(value);
    } else if (key == "light_size") {
      o.light_size = std::stof(value);
    } else if (key == "dynamic") {
      o.dynamic = value == "true";
    } else if (key == "soup") {
      o.soup = value == "true";
    } else if (key == "quick") {
      o.quick = value == "true";
    } else if (key == "avx2") {
      o.avx2 = value == "true";
    } else if (key == "packets") {
      o.packets.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) o.packets.push_back(one);
    } else {
      throw InputError("Unknown option '" + key + "'." +
                       suggestion(key, {"k", "techniques", "resolution", "light_size", "dynamic", "soup",
                                        "quick", "packets", "avx2"}));
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
    // Smaller is wider.
    if (options.avx2) hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~(HWY_AVX2 - 1));
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
