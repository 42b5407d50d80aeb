#include "tests/micro/contest/contest.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/error.h"
#include "run/statistics.h"
#include "techniques/registry.h"
#include "tests/techniques/gears_render.h"

namespace penumbra::contest {
namespace {

using testing::DeviceScene;

// Processor time of all threads so far, in ms.
double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// A technique that is built on a scene, wherever it wants its output.
class Contestant {
 public:
  Contestant(DeviceScene& scene, const std::string& name, const ParamValues& given) : scene_(scene) {
    const Registry registry = all_techniques();
    const TechniqueInfo& info = find_technique(registry, name);
    const ParamValues params = resolve(info.params, given, name);
    technique_ = info.make(params);
    if (const auto reason = technique_->supports(scene.scene_case)) throw InputError(*reason);
    const std::size_t pixels = scene.view->host().pixel_count(),
                      words = pixels * static_cast<std::size_t>(scene.samples.mask_words());
    if (info.residence_with(params) == Residence::host) {
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

  // One frame, by the passes' own clock, and what each pass took.
  void measure(benchmark::State& state, bool show_passes) {
    std::vector<gpu::PassTime> passes;
    double processor = 0;
    for ([[maybe_unused]] auto _ : state) {
      scene_.passes.take_times();
      processor = -processor_ms();
      render();
      processor += processor_ms();
      passes = scene_.passes.take_times();
      double ms = 0;
      for (const gpu::PassTime& p : passes) ms += p.ms;
      state.SetIterationTime(ms / 1000);
    }
    state.counters["processor_ms"] = processor;
    if (show_passes)
      for (const gpu::PassTime& p : passes) state.counters[p.name] = p.ms;
  }
  void render() {
    technique_->render(in_, scene_.passes);
    scene_.passes.finish();
  }
  void print_counters(const std::string& of) {
    for (const auto& [counter, value] : technique_->counters())
      if (const double* number = std::get_if<double>(&value)) fmt::print("{} {}: {}\n", of, counter, *number);
  }

 private:
  DeviceScene& scene_;
  std::unique_ptr<Technique> technique_;
  gpu::Buffer visibility_, mask_;
  std::vector<float> host_visibility_;
  std::vector<uint32_t> host_mask_;
  RenderInput in_;
};

// Everything for one scene and mask size.
struct Contest {
  std::unique_ptr<DeviceScene> scene;
  std::map<std::string, std::unique_ptr<Contestant>> contestants;
};

void add(gpu::Device& device, const Options& options, const std::string& name, int k, Contest& contest) {
  contest.scene = std::make_unique<DeviceScene>(
      device, Scene::load(name, {"configs/scenes"}).frame(0, options.light, "", -1), options.resolution,
      options.resolution, LightSampleRequest{k, k});
  const auto add_one = [&](const std::string& what, const std::string& technique, const ParamValues& params,
                           bool opponent) {
    const auto run = [&options, &contest, name, what, technique, params, opponent](benchmark::State& state) {
      auto& contestant = contest.contestants[what];
      if (!contestant) {
        contestant = std::make_unique<Contestant>(*contest.scene, technique, params);
        contestant->render();  // not counted
        if (options.counters && !opponent) contestant->print_counters(name);
      }
      contestant->measure(state, !opponent);
    };
    benchmark::RegisterBenchmark(fmt::format("{}/k:{}/{}", name, k, what).c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  };
  for (const std::string& opponent : options.opponents) {
    const std::size_t split = opponent.find('_');
    add_one("embree_" + opponent, "ray_tracing",
            {{"packet", opponent.substr(0, split)}, {"coherent", opponent.substr(split + 1)}}, true);
  }
  add_one(options.technique, options.technique, options.params, false);
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
  // Of one scene and mask size: the fastest opponent over the technique, repetition by repetition.
  void print_ratio(const std::string& contest) const {
    const std::vector<double>*own = nullptr, *embree = nullptr;
    std::string fastest;
    for (const auto& [name, times] : times_) {
      if (!name.starts_with(contest + "/")) continue;
      const std::string what = name.substr(contest.size() + 1);
      if (what == technique_)
        own = &times;
      else if (!embree || median(times) < median(*embree))
        embree = &times, fastest = what;
    }
    if (!own || !embree) return;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(own->size(), embree->size()); ++i)
      ratios.push_back((*embree)[i] / (*own)[i]);
    std::ranges::sort(ratios);
    const auto interval = penumbra::run::median_interval(ratios);
    fmt::print("{}: {} {:.1f} ms, {} {:.1f} ms: {:.2f} times as fast, {:.2f} to {:.2f} in {} repetitions\n",
               contest, fastest, median(*embree), technique_, median(*own), median(*embree) / median(*own),
               interval[0], interval[1], ratios.size());
    std::fflush(stdout);
  }

 private:
  static double median(std::vector<double> times) {
    std::ranges::sort(times);
    return penumbra::run::quantile(times, 0.5);
  }
  std::string technique_;
  std::map<std::string, std::vector<double>> times_;
};

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string one; std::getline(in, one, ',');) parts.push_back(one);
  return parts;
}

std::vector<std::string> read_opponents(const std::string& value) {
  if (value == "none") return {};
  const std::vector<std::string> known = Options{}.opponents, wanted = split_list(value);
  for (const std::string& one : wanted)
    if (std::ranges::find(known, one) == known.end())
      throw InputError("Unknown opponent '" + one + "'." + suggestion(one, known));
  return wanted;
}

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
      for (const std::string& one : split_list(value)) o.k.push_back(std::stoi(one));
    } else if (key == "opponents") {
      o.opponents = read_opponents(value);
    } else if (key == "counters") {
      o.counters = value == "true";
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
  // Google Benchmark draws an order of its own only when asked.
  std::vector<char*> args(argv, argv + argc);
  char interleave[] = "--benchmark_enable_random_interleaving=true";
  args.insert(args.begin() + 1, interleave);
  int count = static_cast<int>(args.size());
  benchmark::Initialize(&count, args.data());
  try {
    read(count, args.data(), options);
    gpu::Device device{gpu::DeviceOptions{}};
    Ratios reporter(options.technique);
    // One after the other, so that only one scene is in memory.
    for (const std::string& name : options.scenes)
      for (const int k : options.k) {
        Contest contest;
        try {
          add(device, options, name, k, contest);
        } catch (const InputError& e) {
          fmt::print(stderr, "left out: {}\n", e.what());
          continue;
        }
        benchmark::RunSpecifiedBenchmarks(&reporter);
        reporter.print_ratio(fmt::format("{}/k:{}", name, k));
        benchmark::ClearRegisteredBenchmarks();
      }
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

}  // namespace penumbra::contest
