#include "tests/micro/contest/contest.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "techniques/registry.h"
#include "tests/techniques/gears_render.h"

namespace penumbra::contest {
namespace {

using testing::DeviceScene;

// Milliseconds of all passes since the last call.
double taken(gpu::PassRecorder& passes) {
  double ms = 0;
  for (const gpu::PassTime& p : passes.take_times()) ms += p.ms;
  return ms;
}

// A technique that is built on a scene, wherever it wants its output.
class Contestant {
 public:
  Contestant(DeviceScene& scene, const std::string& name, const ParamValues& given) : scene_(scene) {
    const Registry registry = all_techniques();
    const TechniqueInfo& info = find_technique(registry, name);
    technique_ = info.make(resolve(info.params, given, name));
    if (const auto reason = technique_->supports(scene.scene_case)) throw InputError(*reason);
    const std::size_t pixels = scene.view->host().pixel_count(),
                      words = pixels * static_cast<std::size_t>(scene.samples.mask_words());
    if (info.residence == Residence::host) {
      host_visibility_.resize(pixels), host_mask_.resize(words);
      in_.host = {host_visibility_, host_mask_};
    } else {
      visibility_ = gpu::Buffer(scene.device, pixels * 4, gpu::Memory::device, "visibility");
      mask_ = gpu::Buffer(scene.device, words * 4, gpu::Memory::device, "masks");
      in_.device = {&visibility_, &mask_};
    }
    in_.scene_case = &scene.scene_case, in_.view_samples = scene.view.get();
    technique_->setup(scene.scene_case, scene.passes);
    technique_->build(scene.scene_case, scene.passes);
    scene.passes.finish();
  }
  Contestant(const Contestant&) = delete;

  // One frame per iteration, by the passes' own clock.
  void measure(benchmark::State& state) {
    render();
    taken(scene_.passes);
    for ([[maybe_unused]] auto _ : state) {
      render();
      state.SetIterationTime(taken(scene_.passes) / 1000);
    }
  }

 private:
  void render() {
    technique_->render(in_, scene_.passes);
    scene_.passes.finish();
  }
  DeviceScene& scene_;
  std::unique_ptr<Technique> technique_;
  gpu::Buffer visibility_, mask_;
  std::vector<float> host_visibility_;
  std::vector<uint32_t> host_mask_;
  RenderInput in_;
};

// Everything for one scene and mask size, made on first use: the dragons are large.
struct Contest {
  std::unique_ptr<DeviceScene> scene;
  std::map<std::string, std::unique_ptr<Contestant>> contestants;
};

void add(gpu::Device& device, const Options& options, const std::string& name, int k, Contest& contest) {
  const auto add_one = [&](const std::string& what, const std::string& technique, const ParamValues& params) {
    const auto run = [&device, &options, &contest, name, k, what, technique,
                      params](benchmark::State& state) {
      if (!contest.scene)
        contest.scene = std::make_unique<DeviceScene>(
            device, Scene::load(name, {"configs/scenes"}).frame(0, options.light, "", -1), options.resolution,
            options.resolution, LightSampleRequest{k, k});
      auto& contestant = contest.contestants[what];
      if (!contestant) contestant = std::make_unique<Contestant>(*contest.scene, technique, params);
      contestant->measure(state);
    };
    benchmark::RegisterBenchmark(fmt::format("{}/k:{}/{}", name, k, what).c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  for (const char* packet : {"8", "16"})
    for (const char* coherent : {"on", "off"})
      add_one(fmt::format("embree_{}_coherent_{}", packet, coherent), "ray_tracing",
              {{"packet", std::string(packet)}, {"coherent", std::string(coherent)}});
  add_one(options.technique, options.technique, options.params);
}

// Prints as usual, and keeps the times for the closing ratios.
class Ratios : public benchmark::ConsoleReporter {
 public:
  explicit Ratios(std::string technique) : technique_(std::move(technique)) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[run.run_name.function_name].push_back(run.GetAdjustedRealTime());
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    std::map<std::string, std::pair<double, double>> best;  // scene and k: Embree, the technique
    for (auto& [name, times] : times_) {
      std::ranges::sort(times);
      const double median = times[times.size() / 2];
      const std::size_t slash = name.rfind('/');
      auto& [embree, other] = best.try_emplace(name.substr(0, slash), INFINITY, INFINITY).first->second;
      double& slot = name.substr(slash + 1) == technique_ ? other : embree;
      slot = std::min(slot, median);
    }
    for (const auto& [name, times] : best)
      fmt::print("{}: embree {:.0f} ms, {} {:.0f} ms: {:.2f} times as fast\n", name, times.first, technique_,
                 times.second, times.first / times.second);
  }

 private:
  std::string technique_;
  std::map<std::string, std::vector<double>> times_;
};

void read(int argc, char** argv, Options& o) {
  std::vector<std::string> scenes;
  for (int i = 1; i < argc; ++i) {
    const std::string arg = argv[i];
    const std::size_t equals = arg.find('=');
    if (equals == std::string::npos) {
      scenes.push_back(arg);
      continue;
    }
    const std::string key = arg.substr(0, equals), value = arg.substr(equals + 1);
    if (key == "k") {
      o.k.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) o.k.push_back(std::stoi(one));
    } else if (key == "resolution") {
      o.resolution = std::stoi(value);
    } else if (key == "light") {
      o.light = value;
    } else if (value == "true" || value == "false") {
      o.params[key] = value == "true";
    } else if (!value.empty() && value.find_first_not_of("0123456789") == std::string::npos) {
      o.params[key] = int64_t{std::stoll(value)};
    } else if (!value.empty() && value.find_first_not_of("0123456789.") == std::string::npos) {
      o.params[key] = std::stod(value);
    } else {
      o.params[key] = value;
    }
  }
  if (!scenes.empty()) o.scenes = scenes;
}

}  // namespace

int run(int argc, char** argv, Options options) {
  benchmark::Initialize(&argc, argv);
  try {
    read(argc, argv, options);
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
    Ratios reporter(options.technique);
    benchmark::RunSpecifiedBenchmarks(&reporter);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

}  // namespace penumbra::contest
