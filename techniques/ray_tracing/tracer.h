// The shadow rays of a picture: every view sample to every light sample that is above its horizon.
#pragma once
#include <cstdint>
#include <span>

#include "embree/embree.h"
#include "samples/view_samples.h"
#include "techniques/ray_tracing/light_packets.h"
#include "techniques/ray_tracing/params.h"

namespace penumbra::ray_tracing {

struct TraceSettings {
  int packet = 16;                // 1, 4, 8 or 16 rays per call
  bool pixels_in_packet = false;  // else a packet's rays go from one view sample to several light samples
  embree::Coherence coherence = embree::Coherence::incoherent;
};

// What the room's parameters mean for a scene of so many triangles, a set of so many light samples, and a
// processor whose vectors hold `native_packet` rays (EmbreeHierarchy::native_packet).
TraceSettings trace_settings(const RayTracingParams& params, std::size_t triangles, int light_samples,
                             int native_packet);

struct TraceCounts {
  uint64_t rays = 0;
  uint64_t without_ray = 0;  // light samples below the horizon, behind the rectangle or outside the cone
};

// Where the horizon rule is judged (P) and where the rays start (P').
struct ViewSample {
  Vec3f position, origin, normal;
};

class Tracer {
 public:
  // What the loops need of the light. May allocate; trace() does not.
  void assign(const Light& light, const LightSamples& samples, const TraceSettings& settings);

  // Writes every pixel: its mask (mask_words words, 1 = blocked, bits past the count 0) and its visibility,
  // the weight of the samples that are not blocked. Pixels without a view sample get 1 and an empty mask.
  TraceCounts trace(RTCScene scene, const ViewSamplesHost& view, std::span<float> visibility,
                    std::span<uint32_t> mask) const;

  const TraceSettings& settings() const { return settings_; }
  uint64_t bytes() const;

 private:
  enum class Horizon { above, across, below };
  struct Job;
  struct Task;
  template <int N>
  void run(const Job& job) const;
  template <int N>
  void trace_light(const Task& task) const;
  template <int N>
  void trace_pixels(const Task& task) const;
  std::size_t gather(const Job& job, std::size_t tile, uint32_t* pixels) const;
  // A packet's coordinates.
  struct Targets {
    const float *x, *y, *z;
  };
  // Of the common set, or (moved: of LightPackets::move) of a pixel's own.
  Targets targets(std::size_t packet, const std::vector<float>& moved) const;
  template <int N>
  uint32_t above_horizon(const ViewSample& v, const Targets& targets) const;
  Horizon horizon(const ViewSample& v) const;
  bool lit_side(Vec3f position) const;
  float visibility(const uint32_t* mask) const;

  TraceSettings settings_;
  LightPackets packets_;
  LightSamples samples_;
  bool at_infinity_ = false;
  LightKind kind_ = LightKind::point;
  Vec3f center_, direction_;
  float cone_cosine_ = -1;
  std::size_t words_ = 1;
};

}  // namespace penumbra::ray_tracing
