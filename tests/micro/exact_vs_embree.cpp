// The exact techniques that run on the host, all their per-frame stages, against Embree's fastest packets in
// one run, on the study's scenes, and what each stage takes:
//   micro_exact_vs_embree [SCENE ...] [k=16,32] [techniques=depth,clusters,triangles] [resolution=512]
//   [light_size=D] [dynamic=true] [soup=true] [holes=0.1] [quick=true] [packets=8,16] [avx2=true]
//   [counters=true] [--benchmark_repetitions=5]
// techniques: depth_complexity_sampling, and gears with backend=cpu and either assignment; depth and clusters
// by default. Each stage's milliseconds are printed as counters; find_edges_once and order_triangles_once are
// made once for a topology, no part of a frame. Scenes are names under configs/scenes (the study_* scenes
// that are there by default). The opponent is ray_tracing, not robust, with packets of 8 and 16 rays and both
// coherence hints (dynamic: with its own choice of packet, at its low, medium and refitted build qualities):
// the fastest counts. light_size: the rectangle's diagonal. dynamic: all sides take the vertices anew each
// frame, and building counts. soup: each triangle shrunk by a thousandth, so that every edge is open. holes:
// that share of the triangles left out. quick: one opponent, ray_tracing as it chooses for itself; none: no
// opponent. packets: those of the opponent. avx2: the techniques, not Embree, without AVX-512. counters:
// prints those of the techniques. Repetitions come in random order; each technique's first frame is not
// counted. processor_ms is that of all threads for a frame; `others` is the share of the processors that
// other programs had meanwhile. The table ends with the ratios of the medians and their 95 % intervals: of
// the repetitions during which other programs had at most a tenth of the processors, and of all of them by
// processor time.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "core/error.h"
#include "run/processors.h"
#include "run/statistics.h"
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
  double holes = 0;
  bool dynamic = false, soup = false, quick = false, none = false, avx2 = false, counters = false;
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
    render();  // not counted
    taken();
  }
  void build() { technique->build(scene.scene_case, scene.passes); }
  void render() {
    RenderInput in;
    in.scene_case = &scene.scene_case, in.view_samples = scene.view.get(), in.host = {visibility, mask};
    technique->render(in, scene.passes);
  }
  void print_counters(const std::string& of) {
    for (const auto& [counter, value] : technique->counters())
      if (const double* number = std::get_if<double>(&value)) fmt::print("{} {}: {}\n", of, counter, *number);
  }
  double taken() {
    double ms = 0;
    for (const gpu::PassTime& p : scene.passes.take_times()) ms += p.ms, passes[p.name] += p.ms;
    return ms;
  }
};

void measure(benchmark::State& state, HostRun& run, bool dynamic) {
  run.passes.clear();
  const auto before = penumbra::run::processor_use();
  const double processor = penumbra::run::process_cpu_s();
  for ([[maybe_unused]] auto _ : state) {
    if (dynamic) run.build();
    run.render();
    state.SetIterationTime(run.taken() / 1000);
  }
  state.counters["processor_ms"] = benchmark::Counter((penumbra::run::process_cpu_s() - processor) * 1e3,
                                                      benchmark::Counter::kAvgIterations);
  if (const auto others = penumbra::run::others_share(before, penumbra::run::processor_use()))
    state.counters["others"] = *others;
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
  if (options.holes > 0) testing::remove_triangles(frame.geometry, options.holes, 2);
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
      if (!r) {
        r = std::make_unique<HostRun>(*contest.scene, technique, params);
        if (options.counters && !label.starts_with("embree")) r->print_counters(name + " " + label);
      }
      measure(s, *r, options.dynamic);
    };
    benchmark::RegisterBenchmark(fmt::format("{}/k:{}/{}", name, k, label).c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  if (options.dynamic)
    for (const std::string quality : {"low", "medium", "refit"})
      add_one("embree_" + quality, "ray_tracing", {{"dynamic", true}, {"build_quality", quality}});
  else if (options.none)
    ;
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
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      Measured& m = measured_[run.run_name.function_name];
      const auto others = run.counters.find("others");
      if (others != run.counters.end() && others->second.value > penumbra::run::busy_share)
        ++m.disturbed;
      else
        m.ms.push_back(run.GetAdjustedRealTime());
      m.processor_ms.push_back(run.counters.at("processor_ms").value);
    }
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    std::map<std::string, std::string> fastest;  // opponent, by scene and k
    for (const auto& [name, m] : measured_) {
      const auto [contest, label] = parts(name);
      if (!label.starts_with("embree")) continue;
      std::string& best = fastest[contest];
      if (best.empty() || median(m.processor_ms) < median(measured_[best].processor_ms)) best = name;
    }
    for (const auto& [name, m] : measured_) {
      const auto [contest, label] = parts(name);
      if (!label.starts_with("embree") && fastest.contains(contest)) print(name, fastest[contest]);
    }
  }

 private:
  struct Measured {
    std::vector<double> ms, processor_ms;
    int disturbed = 0;
  };
  static std::pair<std::string, std::string> parts(const std::string& name) {
    const std::size_t slash = name.rfind('/');
    return {name.substr(0, slash), name.substr(slash + 1)};
  }
  static double median(std::vector<double> times) {
    std::ranges::sort(times);
    return times.empty() ? NAN : penumbra::run::quantile(times, 0.5);
  }
  // Median of the first over that of the second, and its 95 % interval, run by run.
  static std::string ratio(const std::vector<double>& embree, const std::vector<double>& own) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(own.size(), embree.size()); ++i)
      ratios.push_back(embree[i] / own[i]);
    if (ratios.empty()) return "no undisturbed repetition";
    std::ranges::sort(ratios);
    const auto interval = penumbra::run::median_interval(ratios);
    return fmt::format("{:.2f} times as fast, {:.2f} to {:.2f} in {} repetitions",
                       median(embree) / median(own), interval[0], interval[1], ratios.size());
  }
  void print(const std::string& name, const std::string& opponent) {
    const Measured &own = measured_[name], &embree = measured_[opponent];
    const auto [contest, label] = parts(name);
    fmt::print("{}: {} {:.0f} ms, {} {:.1f} ms: {} ({} disturbed)\n  by processor time: {}\n", contest,
               parts(opponent).second, median(embree.ms), label, median(own.ms), ratio(embree.ms, own.ms),
               own.disturbed + embree.disturbed, ratio(embree.processor_ms, own.processor_ms));
  }

  std::map<std::string, Measured> measured_;
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
    } else if (key == "none") {
      o.none = value == "true";
    } else if (key == "holes") {
      o.holes = std::stod(value);
    } else if (key == "counters") {
      o.counters = value == "true";
    } else if (key == "avx2") {
      o.avx2 = value == "true";
    } else if (key == "packets") {
      o.packets.clear();
      std::istringstream list(value);
      for (std::string one; std::getline(list, one, ',');) o.packets.push_back(one);
    } else {
      throw InputError("Unknown option '" + key + "'." +
                       suggestion(key, {"k", "techniques", "resolution", "light_size", "dynamic", "soup",
                                        "holes", "quick", "none", "packets", "avx2", "counters"}));
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
  // Google Benchmark draws an order of its own only when asked.
  std::vector<char*> args(argv, argv + argc);
  char interleave[] = "--benchmark_enable_random_interleaving=true";
  args.insert(args.begin() + 1, interleave);
  int count = static_cast<int>(args.size());
  benchmark::Initialize(&count, args.data());
  try {
    const Options options = read(count, args.data());
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
