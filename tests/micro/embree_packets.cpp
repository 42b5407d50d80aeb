// Plain Embree loops over a study scene's shadow rays - single rays and packets, with and without the
// coherence hint - against the room ray_tracing, with its defaults and with fixed
// settings, in one run:
//   micro_embree_packets [SCENE ...] [--benchmark_...]
// Scenes are names under configs/scenes (study_bunny and study_city by default), 512 x 512, k = 16 and 32.
// All trace the same rays on hierarchies of the same quality; the loops only count what is visible. The table
// ends with the ratio of the fastest loop's time to ray_tracing's, from the medians of
// --benchmark_repetitions.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>

#include "core/error.h"
#include "core/parallel.h"
#include "embree/embree.h"
#include "embree/flush_denormals.h"
#include "techniques/common/embree_hierarchy.h"
#include "techniques/ray_tracing/tracer.h"
#include "tests/support/host_view.h"

namespace penumbra {
namespace {

template <int N>
struct alignas(64) Rays {
  float org_x[N], org_y[N], org_z[N], tnear[N], dir_x[N], dir_y[N], dir_z[N], time[N], tfar[N];
  unsigned mask[N], id[N], flags[N];
};
static_assert(sizeof(Rays<16>) == sizeof(RTCRay16) && sizeof(Rays<8>) == sizeof(RTCRay8));

template <int N>
void occluded(embree::Query& query, const int* valid, RTCScene scene, Rays<N>& rays) {
  void* r = &rays;
  if constexpr (N == 1) query.occluded(scene, static_cast<RTCRay*>(r));
  if constexpr (N == 8) query.occluded(valid, scene, static_cast<RTCRay8*>(r));
  if constexpr (N == 16) query.occluded(valid, scene, static_cast<RTCRay16*>(r));
}

struct Study {
  std::string name;
  Frame frame;
  testing::HostView view;
  EmbreeHierarchy hierarchy{HierarchyQuality::high, false, false};
  std::map<int, std::vector<uint32_t>> evaluated;  // by k: pixels with a ray to trace
  std::map<int, LightSamples> samples;
  std::map<int, uint64_t> rays;

  explicit Study(const std::string& scene_name) : name(scene_name) {
    frame = Scene::load(scene_name, {"configs/scenes"}).frame(0, "", "", -1);
    view = testing::see(frame.geometry, frame.camera, 512, 512);
    hierarchy.load(frame.geometry);
    hierarchy.commit();
    for (const int k : {16, 32}) {
      samples[k] = testing::regular_samples(frame.light, k, k);
      for (uint32_t p = 0; p < view.triangle.size(); ++p) {
        if (view.triangle[p] == no_triangle) continue;
        uint64_t above = 0;
        for (const Vec4f& l : samples[k].points) above += has_ray(p, l);
        if (above > 0) evaluated[k].push_back(p);
        rays[k] += above;
      }
    }
  }
  // Above the horizon and in front of the rectangle.
  bool has_ray(uint32_t pixel, const Vec4f& l) const {
    const Vec3f to_light = l.xyz() - view.position[pixel].xyz();
    return dot(view.geometric_normal[pixel].xyz(), to_light) > 0 && dot(frame.light.direction, to_light) < 0;
  }
};

constexpr int width_of(int packet) { return packet == 1 ? 1 : 4; }

// One view sample after the other; a packet is a tile of light samples. Returns how many are visible.
template <int N>
uint64_t trace_tiles(const Study& study, int k, const std::vector<uint32_t>& pixels,
                     embree::Coherence coherence) {
  constexpr int columns = width_of(N), rows = N / columns;
  const Vec4f* light = study.samples.at(k).points.data();
  Rays<N> rays{};
  alignas(64) int valid[N];
  std::fill_n(rays.mask, N, ~0U);
  embree::Query query(coherence);
  uint64_t visible = 0;
  for (const uint32_t pixel : pixels) {
    const Vec3f o = study.view.origin[pixel].xyz(), p = study.view.position[pixel].xyz();
    const Vec3f n = study.view.geometric_normal[pixel].xyz();
    for (int i = 0; i < N; ++i) rays.org_x[i] = o.x, rays.org_y[i] = o.y, rays.org_z[i] = o.z;
    for (int row = 0; row < k; row += rows)
      for (int column = 0; column < k; column += columns) {
        for (int i = 0; i < N; ++i) {
          const Vec4f& l = light[(row + i / columns) * k + column + i % columns];
          valid[i] = n.x * (l.x - p.x) + n.y * (l.y - p.y) + n.z * (l.z - p.z) > 0 ? -1 : 0;
          rays.dir_x[i] = l.x - o.x, rays.dir_y[i] = l.y - o.y, rays.dir_z[i] = l.z - o.z;
          rays.tfar[i] = 1;
        }
        if (N == 1 && !valid[0]) continue;
        occluded<N>(query, valid, study.hierarchy.scene(), rays);
        for (int i = 0; i < N; ++i) visible += valid[i] != 0 && rays.tfar[i] >= 0;
      }
  }
  return visible;
}

template <int N>
void loop(benchmark::State& state, const Study& study, int k, embree::Coherence coherence) {
  const std::vector<uint32_t>& pixels = study.evaluated.at(k);
  uint64_t visible = 0;
  for ([[maybe_unused]] auto _ : state) {
    std::atomic<uint64_t> sum{0};
    parallel_for(pixels.size(), 256, [&](std::size_t begin, std::size_t end) {
      const embree::FlushDenormals flush;
      sum += trace_tiles<N>(
          study, k, {pixels.begin() + static_cast<long>(begin), pixels.begin() + static_cast<long>(end)},
          coherence);
    });
    visible = sum;
  }
  const auto rays = static_cast<double>(study.rays.at(k));
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["visible"] = static_cast<double>(visible) / rays;
}

void technique(benchmark::State& state, const Study& study, int k,
               const ray_tracing::TraceSettings& settings) {
  const LightSamples& samples = study.samples.at(k);
  ray_tracing::Tracer tracer;
  tracer.assign(study.frame.light, samples, settings);
  std::vector<float> visibility(study.view.triangle.size());
  std::vector<uint32_t> mask(visibility.size() * static_cast<std::size_t>(samples.mask_words()));
  ray_tracing::TraceCounts counts;
  for ([[maybe_unused]] auto _ : state)
    counts = tracer.trace(study.hierarchy.scene(), study.view.host(), visibility, mask);
  double visible = 0;
  for (const uint32_t pixel : study.evaluated.at(k))
    visible += static_cast<double>(visibility[pixel]) * static_cast<double>(samples.count());
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(counts.rays), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["visible"] = visible / static_cast<double>(counts.rays);
}

template <class F>
void add(const std::string& name, F run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->UseRealTime();
}

void add_all(const Study& study) {
  using embree::Coherence;
  for (const int k : {16, 32}) {
    const std::string of = fmt::format("{}/k:{}/", study.name, k);
    for (const Coherence c : {Coherence::coherent, Coherence::incoherent}) {
      const std::string hint = c == Coherence::coherent ? "coherent" : "incoherent";
      add(of + "loop_1_" + hint, [&study, k, c](auto& s) { loop<1>(s, study, k, c); });
      add(of + "loop_8_" + hint, [&study, k, c](auto& s) { loop<8>(s, study, k, c); });
      add(of + "loop_16_" + hint, [&study, k, c](auto& s) { loop<16>(s, study, k, c); });
      for (const int packet : {8, 16})
        add(fmt::format("{}ray_tracing_{}_{}", of, packet, hint), [&study, k, c, packet](auto& s) {
          technique(s, study, k, {packet, false, c});
        });
    }
    add(of + "ray_tracing", [&study, k](auto& s) {
      technique(s, study, k,
                ray_tracing::trace_settings({}, study.frame.geometry.triangle_count(), k * k,
                                            study.hierarchy.native_packet()));
    });
  }
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
    std::map<std::string, std::map<std::string, double>> medians;  // scene and k, then loop
    for (auto& [name, times] : times_) {
      std::ranges::sort(times);
      const std::size_t slash = name.rfind('/');
      medians[name.substr(0, slash)][name.substr(slash + 1)] = times[times.size() / 2];
    }
    for (const auto& [of, loops] : medians) {
      double fastest = INFINITY;
      for (const auto& [name, ms] : loops)
        if (name.starts_with("loop")) fastest = std::min(fastest, ms);
      for (const auto& [name, ms] : loops)
        if (name.starts_with("ray_tracing"))
          fmt::print("{}: fastest loop {:.0f} ms, {} {:.0f} ms: {:.3f} of the loop's rate\n", of, fastest,
                     name, ms, fastest / ms);
    }
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = {"study_bunny", "study_city"};
  std::vector<std::unique_ptr<penumbra::Study>> studies;
  try {
    for (const std::string& name : names) {
      studies.push_back(std::make_unique<penumbra::Study>(name));
      penumbra::add_all(*studies.back());
    }
  } catch (const penumbra::InputError& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  penumbra::Ratios reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
