#include "techniques/ray_tracing/tracer.h"

#include <algorithm>
#include <atomic>
#include <numbers>

#include "core/parallel.h"
#include "embree/flush_denormals.h"
#include "techniques/ray_tracing/ray_packet.h"

namespace penumbra::ray_tracing {
namespace {

// Pixels are traced in square tiles: neighbours in the picture walk the same part of the hierarchy.
constexpr int tile_side = 16;
constexpr std::size_t tile_pixels = tile_side * tile_side;

int tiles_across(int pixels) { return (pixels + tile_side - 1) / tile_side; }

ViewSample view_sample(const ViewSamplesHost& view, std::size_t pixel) {
  return {view.position[pixel].xyz(), view.origin[pixel].xyz(), view.geometric_normal[pixel].xyz()};
}

// The shared horizon rule: a light sample with dot(Ng, L - P) <= 0 is blocked without a ray. P is the
// position, not the ray's origin P'. `scale` is 1, or 0 for a light at infinity, where L is a direction.
float height(const ViewSample& v, float x, float y, float z, float scale) {
  return v.normal.x * (x - scale * v.position.x) + v.normal.y * (y - scale * v.position.y) +
         v.normal.z * (z - scale * v.position.z);
}

// Pixel i of a tile: 4 x 4 blocks, each in Morton order, so that 4, 8 or 16 consecutive pixels are 2 x 2, 4 x
// 2 or 4 x 4.
void pixel_in_tile(std::size_t i, int& x, int& y) {
  const int block = static_cast<int>(i / 16), inside = static_cast<int>(i % 16);
  x = block % (tile_side / 4) * 4 + (inside & 1) + (inside >> 2 & 1) * 2;
  y = block / (tile_side / 4) * 4 + (inside >> 1 & 1) + (inside >> 3 & 1) * 2;
}

}  // namespace

struct Tracer::Job {
  RTCScene scene;
  const ViewSamplesHost& view;
  std::span<float> visibility;
  std::span<uint32_t> mask;
  mutable std::atomic<uint64_t> rays{0}, without_ray{0};
};

// One tile's pixels that need rays.
struct Tracer::Task {
  const Job& job;
  const uint32_t* pixels;
  std::size_t pixel_count;
  mutable uint64_t without_ray = 0;
};

void Tracer::assign(const Light& light, const LightSamples& samples, const TraceSettings& settings) {
  settings_ = settings;
  packets_.assign(samples, settings.packet);
  samples_ = samples;
  at_infinity_ = samples.points.front().w == 0;
  kind_ = light.kind, center_ = light.center, direction_ = light.direction;
  cone_cosine_ = static_cast<float>(std::cos(light.cone_degrees * std::numbers::pi / 180));
  words_ = static_cast<std::size_t>(samples.mask_words());
}

uint64_t Tracer::bytes() const {
  return packets_.bytes() + samples_.points.capacity() * sizeof(Vec4f) +
         samples_.weights.capacity() * sizeof(float) + samples_.units.capacity() * sizeof(Vec2f);
}

// A rectangle shines from its front only and a spot light inside its cone only.
bool Tracer::lit_side(Vec3f position) const {
  const Vec3f from_light = position - center_;
  if (kind_ == LightKind::rectangle || kind_ == LightKind::textured_rectangle)
    return dot(direction_, from_light) > 0;
  if (kind_ == LightKind::spot) return dot(direction_, from_light) >= cone_cosine_ * length(from_light);
  return true;
}

// Where all light samples lie, beyond any rounding: by the lowest and the highest corner of their bounds.
Tracer::Horizon Tracer::horizon(const ViewSample& v) const {
  const Box& box = packets_.bounds();
  const float scale = at_infinity_ ? 0.0F : 1.0F;
  const auto height_of = [&](const Vec3f& against, const Vec3f& along) {
    const auto corner = [](float n, float if_negative, float otherwise) {
      return n < 0 ? if_negative : otherwise;
    };
    return height(v, corner(v.normal.x, against.x, along.x), corner(v.normal.y, against.y, along.y),
                  corner(v.normal.z, against.z, along.z), scale);
  };
  const auto size = [](const Vec3f& p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); };
  const float rounding = 1e-5F * (size(box.lo) + size(box.hi) + size(v.position));
  if (height_of(box.hi, box.lo) > rounding) return Horizon::above;
  return height_of(box.lo, box.hi) < -rounding ? Horizon::below : Horizon::across;
}

float Tracer::visibility(const uint32_t* mask) const {
  if (samples_.uniform_weights) {
    std::size_t blocked = 0;
    for (std::size_t w = 0; w < words_; ++w) blocked += bit_count(mask[w]);
    return static_cast<float>(samples_.points.size() - blocked) / static_cast<float>(samples_.points.size());
  }
  double sum = 0;
  for (std::size_t i = 0; i < samples_.points.size(); ++i)
    if ((mask[i / 32] >> (i % 32) & 1) == 0) sum += static_cast<double>(samples_.weights[i]);
  return static_cast<float>(std::min(sum, 1.0));
}

// The pixels of a tile that need rays, in the order of pixel_in_tile(); the others' outputs are written here.
std::size_t Tracer::gather(const Job& job, std::size_t tile, uint32_t* pixels) const {
  const int across = tiles_across(job.view.width);
  const int x0 = static_cast<int>(tile) % across * tile_side,
            y0 = static_cast<int>(tile) / across * tile_side;
  const uint32_t tail = samples_.points.size() % 32 ? (1U << samples_.points.size() % 32) - 1 : ~0U;
  std::size_t count = 0;
  for (std::size_t i = 0; i < tile_pixels; ++i) {
    int x = 0, y = 0;
    pixel_in_tile(i, x, y);
    if (x0 + x >= job.view.width || y0 + y >= job.view.height) continue;
    const std::size_t pixel = static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(job.view.width) +
                              static_cast<std::size_t>(x0 + x);
    uint32_t* mask = &job.mask[pixel * words_];
    const bool sees = job.view.triangle[pixel] != no_triangle;
    std::fill_n(mask, words_, 0U);
    if (sees && lit_side(job.view.position[pixel].xyz()) &&
        horizon(view_sample(job.view, pixel)) != Horizon::below) {
      pixels[count++] = static_cast<uint32_t>(pixel);
      continue;
    }
    if (sees) std::fill_n(mask, words_, ~0U), mask[words_ - 1] = tail;
    if (sees) job.without_ray.fetch_add(samples_.points.size(), std::memory_order_relaxed);
    job.visibility[pixel] = sees ? 0.0F : 1.0F;
  }
  return count;
}

Tracer::Targets Tracer::targets(std::size_t packet, const std::vector<float>& moved) const {
  if (moved.empty()) return {packets_.x(packet), packets_.y(packet), packets_.z(packet)};
  const float* x = &moved[packet * static_cast<std::size_t>(settings_.packet)];
  return {x, x + packets_.slots(), x + 2 * packets_.slots()};
}

// Which of a packet's lanes are above the horizon.
template <int N>
uint32_t Tracer::above_horizon(const ViewSample& v, const Targets& t) const {
  const float scale = at_infinity_ ? 0.0F : 1.0F;
  alignas(64) float minus_height[N];
  for (int lane = 0; lane < N; ++lane)
    minus_height[lane] = -height(v, t.x[lane], t.y[lane], t.z[lane], scale);
  return below_zero<N>(minus_height);
}

// One view sample after the other, each packet a group of neighbouring light samples.
template <int N>
void Tracer::trace_light(const Task& task) const {
  const Job& job = task.job;
  embree::Query query(settings_.coherence);
  // Taken in turn: a packet is written while its predecessor is traced, as reading back at once what was just
  // written in narrower pieces stalls the processor.
  ShadowRays<N> rays[2] = {ShadowRays<N>(at_infinity_), ShadowRays<N>(at_infinity_)};
  const std::size_t packets = packets_.count();
  static thread_local std::vector<float> moved;
  moved.clear();
  for (std::size_t i = 0; i < task.pixel_count; ++i) {
    const std::size_t pixel = task.pixels[i];
    const ViewSample v = view_sample(job.view, pixel);
    if (samples_.move != PixelMove::none) packets_.move(samples_, samples_.draw(pixel), moved);
    const bool all_above = horizon(v) == Horizon::above;
    uint32_t* mask = &job.mask[pixel * words_];
    rays[0].start(v.origin), rays[1].start(v.origin);
    Targets here = targets(0, moved);
    rays[0].aim(here.x, here.y, here.z);
    for (std::size_t p = 0; p < packets; ++p) {
      const Targets next = targets(std::min(p + 1, packets - 1), moved);
      rays[(p + 1) % 2].aim(next.x, next.y, next.z);
      const uint32_t used = packets_.used(p), wanted = all_above ? used : used & above_horizon<N>(v, here);
      uint32_t bits = used & ~wanted;
      if (bits) task.without_ray += bit_count(bits);
      if (wanted) bits |= rays[p % 2].blocked(job.scene, query, wanted) & wanted;
      if (bits) packets_.scatter(p, bits, mask);
      here = next;
    }
    job.visibility[pixel] = visibility(mask);
  }
}

// Each packet a group of neighbouring pixels, one light sample after the other.
template <int N>
void Tracer::trace_pixels(const Task& task) const {
  const Job& job = task.job;
  embree::Query query(settings_.coherence);
  ShadowRays<N> rays(at_infinity_);
  const bool moves = samples_.move != PixelMove::none;
  const float scale = at_infinity_ ? 0.0F : 1.0F;
  for (std::size_t first = 0; first < task.pixel_count; first += N) {
    const std::size_t used = std::min<std::size_t>(N, task.pixel_count - first);
    ViewSample views[N];
    Vec2f drawn[N];
    uint32_t* masks[N];
    for (std::size_t lane = 0; lane < N; ++lane) {
      const std::size_t pixel = task.pixels[first + std::min(lane, used - 1)];
      views[lane] = view_sample(job.view, pixel);
      masks[lane] = &job.mask[pixel * words_];
      if (moves) drawn[lane] = samples_.draw(pixel);
      rays.start(static_cast<int>(lane), views[lane].origin);
    }
    for (std::size_t s = 0; s < samples_.points.size(); ++s) {
      uint32_t wanted = 0;
      if (moves) {
        for (std::size_t lane = 0; lane < N; ++lane) {
          const Vec4f l = samples_.at(s, drawn[lane]);
          if (lane < used && height(views[lane], l.x, l.y, l.z, scale) > 0) wanted |= 1U << lane;
          rays.aim(static_cast<int>(lane), l.xyz());
        }
      } else {
        const Vec4f l = samples_.points[s];
        for (std::size_t lane = 0; lane < used; ++lane)
          if (height(views[lane], l.x, l.y, l.z, scale) > 0) wanted |= 1U << lane;
        rays.aim(l.xyz());
      }
      uint32_t bits = ((1U << used) - 1) & ~wanted;
      task.without_ray += bit_count(bits);
      if (wanted) bits |= rays.blocked(job.scene, query, wanted) & wanted;
      for (std::size_t lane = 0; bits; ++lane, bits >>= 1)
        if (bits & 1) masks[lane][s / 32] |= 1U << (s % 32);
    }
    for (std::size_t lane = 0; lane < used; ++lane)
      job.visibility[task.pixels[first + lane]] = visibility(masks[lane]);
  }
}

template <int N>
void Tracer::run(const Job& job) const {
  const std::size_t tiles = static_cast<std::size_t>(tiles_across(job.view.width)) *
                            static_cast<std::size_t>(tiles_across(job.view.height));
  struct Call {
    const Tracer& tracer;
    const Job& job;
  } const call{*this, job};
  // One captured reference: std::function then needs no memory of its own.
  parallel_for(tiles, 1, [&call](std::size_t begin, std::size_t end) {
    const embree::FlushDenormals flush;
    const Tracer& tracer = call.tracer;
    for (std::size_t tile = begin; tile < end; ++tile) {
      uint32_t pixels[tile_pixels];
      const std::size_t count = tracer.gather(call.job, tile, pixels);
      const Task task{call.job, pixels, count};
      if (tracer.settings_.pixels_in_packet)
        tracer.trace_pixels<N>(task);
      else
        tracer.trace_light<N>(task);
      call.job.without_ray.fetch_add(task.without_ray, std::memory_order_relaxed);
      call.job.rays.fetch_add(count * tracer.samples_.points.size() - task.without_ray,
                              std::memory_order_relaxed);
    }
  });
}

TraceCounts Tracer::trace(RTCScene scene, const ViewSamplesHost& view, std::span<float> visibility_out,
                          std::span<uint32_t> mask) const {
  const Job job{scene, view, visibility_out, mask};
  switch (settings_.packet) {
    case 1:
      run<1>(job);
      break;
    case 4:
      run<4>(job);
      break;
    case 8:
      run<8>(job);
      break;
    default:
      run<16>(job);
  }
  return {job.rays.load(), job.without_ray.load()};
}

}  // namespace penumbra::ray_tracing
