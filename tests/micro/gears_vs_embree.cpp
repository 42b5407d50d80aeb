// gears, all its per-frame stages, against Embree's fastest packets in one run, on the study's scenes:
//   micro_gears_vs_embree [SCENE ...] [key=value ...] [--benchmark_repetitions=5]
// Scenes are names under configs/scenes (the study_* scenes that are there by default); k=16,32,
// resolution=512, opponents=8_on,8_off,16_on,16_off (or none); counters=true (those of gears, once); any
// other key=value is a parameter of gears.
// The opponent is ray_tracing, not robust, with packets of 8 and 16 rays and the coherence hint on and off:
// the fastest of the four counts. A repetition is one frame of each, in random order, after one that is not
// counted. Counters: processor time of all threads, and the passes of gears. The table ends with the ratios
// of the medians and their 95 % intervals.
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

namespace penumbra {
namespace {

using testing::DeviceScene;
using testing::GearsRun;

// Processor time of all threads so far, in ms.
double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

struct Embree {
  DeviceScene& scene;
  std::unique_ptr<Technique> technique;
  std::vector<float> visibility;
  std::vector<uint32_t> mask;

  Embree(DeviceScene& scene_, const std::string& packet, const std::string& coherent) : scene(scene_) {
    const Registry registry = all_techniques();
    const TechniqueInfo& info = find_technique(registry, "ray_tracing");
    technique = info.make(resolve(info.params, {{"packet", packet}, {"coherent", coherent}}, "ray_tracing"));
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

// One frame, by the passes' own clock.
template <class Renderer>
void measure(benchmark::State& state, DeviceScene& scene, Renderer& renderer, bool show_passes) {
  std::vector<gpu::PassTime> passes;
  double before = 0, after = 0;
  for ([[maybe_unused]] auto _ : state) {
    scene.passes.take_times();
    before = processor_ms();
    renderer.render();
    after = processor_ms();
    passes = scene.passes.take_times();
    double ms = 0;
    for (const gpu::PassTime& p : passes) ms += p.ms;
    state.SetIterationTime(ms / 1000);
  }
  state.counters["processor_ms"] = after - before;
  if (show_passes)
    for (const gpu::PassTime& p : passes) state.counters[p.name] = p.ms;
}

struct Options {
  std::vector<std::string> scenes;
  std::vector<int> k = {16, 32};
  int resolution = 512;
  std::vector<std::string> opponents = {"8_on", "8_off", "16_on", "16_off"};
  bool counters = false;
  ParamValues gears;
};

// Everything for one scene and mask size.
struct Contest {
  std::unique_ptr<DeviceScene> scene;
  std::map<std::string, std::unique_ptr<Embree>> embree;
  std::unique_ptr<GearsRun> gears;
};

void add(gpu::Device& device, const Options& options, const std::string& name, int k, Contest& contest) {
  contest.scene =
      std::make_unique<DeviceScene>(device, Scene::load(name, {"configs/scenes"}).frame(0, "", "", -1),
                                    options.resolution, options.resolution, LightSampleRequest{k, k});
  const auto scene = [&contest]() -> DeviceScene& { return *contest.scene; };
  const std::string of = fmt::format("{}/k:{}/", name, k);
  const auto add_one = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((of + what).c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  };
  for (const std::string& opponent : options.opponents)
    add_one("embree_" + opponent, [=, &contest](benchmark::State& s) {
      auto& e = contest.embree[opponent];
      if (!e) {
        const std::size_t split = opponent.find('_');
        e = std::make_unique<Embree>(scene(), opponent.substr(0, split), opponent.substr(split + 1));
        e->render();
      }
      measure(s, scene(), *e, false);
    });
  add_one("gears", [=, &contest, &options](benchmark::State& s) {
    if (!contest.gears) {
      contest.gears = std::make_unique<GearsRun>(scene(), options.gears);
      contest.gears->render();
      if (options.counters)
        for (const auto& [counter, v] : contest.gears->technique().counters())
          if (const double* number = std::get_if<double>(&v))
            fmt::print("{} {}: {}\n", name, counter, *number);
    }
    measure(s, scene(), *contest.gears, true);
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
  void print_ratio(const std::string& contest) const {
    const std::vector<double>*gears = nullptr, *embree = nullptr;
    std::string fastest;
    for (const auto& [name, times] : times_) {
      if (!name.starts_with(contest + "/")) continue;
      const std::string what = name.substr(contest.size() + 1);
      if (what == "gears")
        gears = &times;
      else if (!embree || median(times) < median(*embree))
        embree = &times, fastest = what;
    }
    if (!gears || !embree) return;
    std::vector<double> ratios;  // of the frames that a repetition gave
    for (std::size_t i = 0; i < std::min(gears->size(), embree->size()); ++i)
      ratios.push_back((*embree)[i] / (*gears)[i]);
    std::ranges::sort(ratios);
    const auto interval = run::median_interval(ratios);
    fmt::print(
        "{}: {} {:.1f} ms, gears {:.1f} ms: {:.2f} times as fast, {:.2f} to {:.2f} in {} repetitions\n",
        contest, fastest, median(*embree), median(*gears), median(*embree) / median(*gears), interval[0],
        interval[1], ratios.size());
    std::fflush(stdout);
  }

 private:
  static double median(std::vector<double> times) {
    std::ranges::sort(times);
    return run::quantile(times, 0.5);
  }
  std::map<std::string, std::vector<double>> times_;
};

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string one; std::getline(in, one, ',');) parts.push_back(one);
  return parts;
}

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
      for (const std::string& one : split(value)) o.k.push_back(std::stoi(one));
    } else if (key == "opponents") {
      o.opponents = value == "none" ? std::vector<std::string>{} : split(value);
      for (const std::string& one : o.opponents)
        if (const auto known = Options{}.opponents; std::ranges::find(known, one) == known.end())
          throw InputError("Unknown opponent '" + one + "'." + suggestion(one, known));
    } else if (key == "counters") {
      o.counters = value == "true";
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
  std::vector<char*> args(argv, argv + argc);
  char interleave[] = "--benchmark_enable_random_interleaving=true";
  args.insert(args.begin() + 1, interleave);
  int count = static_cast<int>(args.size());
  benchmark::Initialize(&count, args.data());
  try {
    const Options options = read(count, args.data());
    gpu::Device device{gpu::DeviceOptions{}};
    Ratios reporter;
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
