#include "reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "embree/embree.h"
#include "embree/flush_denormals.h"
#include "reference/cache.h"
#include "reference/shadow_segments.h"

namespace penumbra {
namespace {

constexpr int batch_count = 8;     // independent estimates behind each standard error
constexpr std::size_t grain = 64;  // pixels per task

void check_embree(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw PointError(fmt::format("Embree cannot make the reference's scene (error {}{}).",
                                 static_cast<int>(error),
                                 error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : ""));
}

ReferenceViewSample view_sample(const ViewSamplesHost& view, std::size_t pixel, ReferenceOrigin origin) {
  const Vec3f position = view.position[pixel].xyz();
  return {position, origin == ReferenceOrigin::offset ? view.origin[pixel].xyz() : position,
          view.geometric_normal[pixel].xyz(), view.triangle[pixel]};
}

uint32_t spread_bits(uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffU;
  v = (v | v << 4) & 0x0f0f0f0fU;
  v = (v | v << 2) & 0x33333333U;
  return (v | v << 1) & 0x55555555U;
}

// Orders the samples along a Morton curve over the light's two widest axes, so that packets hold neighbours.
void sort_along_curve(LightSamples& samples) {
  Box bounds;
  for (const Vec4f& p : samples.points) bounds.extend(p.xyz());
  const Vec3f extent = bounds.hi - bounds.lo;
  int narrow = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (extent[axis] < extent[narrow]) narrow = axis;
  const int a = (narrow + 1) % 3, b = (narrow + 2) % 3;
  const auto cell = [&](const Vec3f& p, int axis) {
    return extent[axis] > 0 ? static_cast<uint32_t>((p[axis] - bounds.lo[axis]) / extent[axis] * 65535.0F)
                            : 0U;
  };
  std::vector<uint32_t> code(samples.points.size());
  for (std::size_t i = 0; i < code.size(); ++i) {
    const Vec3f p = samples.points[i].xyz();
    code[i] = spread_bits(cell(p, a)) | spread_bits(cell(p, b)) << 1;
  }
  std::vector<std::size_t> order(code.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return code[i]; });
  LightSamples sorted = samples;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.points[i] = samples.points[order[i]];
    sorted.weights[i] = samples.weights[order[i]];
  }
  samples = std::move(sorted);
}

std::vector<LightSamples> make_batches(const Light& light, int n, uint32_t seed) {
  // One sample, or a set of points that is the light itself: nothing to estimate.
  if (!light.is_area() || light.kind == LightKind::volume) return {make_reference_samples(light, 1, seed)};
  const int batches = std::clamp(n, 1, batch_count);
  std::vector<LightSamples> sets;
  for (int b = 0; b < batches; ++b) {
    const int size = n / batches + (b < n % batches ? 1 : 0);
    sets.push_back(make_reference_samples(light, size, seed + static_cast<uint32_t>(b) * 0x9e3779b9U));
    sort_along_curve(sets.back());
  }
  return sets;
}

// Batches of points of the unit disc, (x, y, 0): what each view sample then turns towards itself.
std::vector<LightSamples> make_disc_batches(int n, uint32_t seed) {
  Light square;
  square.kind = LightKind::rectangle;
  square.center = {0.5F, 0.5F, 0};
  square.edge_u = {1, 0, 0}, square.edge_v = {0, 1, 0};
  std::vector<LightSamples> sets = make_batches(square, n, seed);
  for (LightSamples& set : sets) {
    for (Vec4f& p : set.points) {
      const double radius = std::sqrt(static_cast<double>(p.x)),
                   angle = 2 * std::numbers::pi * static_cast<double>(p.y);
      p = {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)), 0, 1};
    }
    sort_along_curve(set);
  }
  return sets;
}

// The disc through the sphere's centre across the direction to `position`.
void face(const Light& sphere, Vec3f position, const LightSamples& unit_disc, std::vector<Vec4f>& points) {
  const Vec3d axis = normalize(Vec3d(position) - Vec3d(sphere.center));
  const Vec3d other = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(cross(axis, other)), v = cross(axis, u);
  const Vec3f ru(u * static_cast<double>(sphere.radius)), rv(v * static_cast<double>(sphere.radius));
  points.resize(unit_disc.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f p = sphere.center + (ru * unit_disc.points[i].x + rv * unit_disc.points[i].y);
    points[i] = {p.x, p.y, p.z, 1};
  }
}

// Mean and standard error of the mean of the batches' estimates.
void summarise(std::span<const float> estimates, float& mean, float& standard_error) {
  const double n = static_cast<double>(estimates.size());
  double sum = 0, squares = 0;
  for (const float v : estimates) sum += static_cast<double>(v);
  for (const float v : estimates) squares += std::pow(static_cast<double>(v) - sum / n, 2);
  mean = static_cast<float>(sum / n);
  standard_error = n > 1 ? static_cast<float>(std::sqrt(squares / (n - 1) / n)) : 0.0F;
}

double root_mean_square(const std::vector<float>& values, const std::vector<uint8_t>& evaluated) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (evaluated[i]) sum += static_cast<double>(values[i]) * static_cast<double>(values[i]), ++count;
  return count ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace

struct ReferenceScene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::string geometry_hash;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  // Embree's own buffers hold copies: padded as it needs them, and independent of the caller's.
  void attach(const Geometry& geometry) {
    const RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), geometry.positions.size());
    void* indices = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(uint32_t), geometry.triangle_count());
    check_embree(device);
    std::memcpy(vertices, geometry.positions.data(), geometry.positions.size() * sizeof(Vec3f));
    std::memcpy(indices, geometry.indices.data(), geometry.indices.size() * sizeof(uint32_t));
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
  }
};

ReferenceScene::ReferenceScene(const Geometry& geometry) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  if (!impl_->device) throw PointError("Embree cannot make a device.");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene,
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | embree::query_filter_flag));
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  if (geometry.triangle_count() > 0) impl_->attach(geometry);
  rtcCommitScene(impl_->scene);
  check_embree(impl_->device);
  impl_->geometry_hash = Hasher()
                             .array(std::span<const Vec3f>(geometry.positions))
                             .array(std::span<const uint32_t>(geometry.indices))
                             .hex();
}

ReferenceScene::~ReferenceScene() = default;

MatchedReference ReferenceScene::matched(const ViewSamplesHost& view, const Light& light,
                                         const LightSamples& samples, ReferenceOrigin origin) const {
  const std::size_t pixels = view.pixel_count(), words = static_cast<std::size_t>(samples.mask_words());
  MatchedReference result;
  result.visibility.assign(pixels, 1.0F);
  result.mask.assign(pixels * words, 0U);
  result.evaluated.assign(pixels, 0);
  const ShadowSegments segments(impl_->scene, light, samples, origin);
  parallel_for(pixels, grain, [&](std::size_t begin, std::size_t end) {
    const embree::FlushDenormals flush;
    std::vector<Vec4f> storage;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (view.triangle[pixel] == no_triangle) continue;
      const std::span<uint32_t> mask(&result.mask[pixel * words], words);
      result.evaluated[pixel] =
          segments.blocked(view_sample(view, pixel, origin), samples.of_pixel(pixel, storage), mask);
      if (result.evaluated[pixel]) result.visibility[pixel] = segments.visibility(mask);
    }
  });
  return result;
}

static ReferenceScene::Converged converge(RTCScene scene, const ViewSamplesHost& view, const Light& light,
                                          const std::vector<LightSamples>& batches, ReferenceOrigin origin,
                                          bool facing) {
  const std::size_t pixels = view.pixel_count();
  ReferenceScene::Converged result;
  result.visibility.assign(pixels, 1.0F);
  result.standard_error.assign(pixels, 0.0F);
  result.evaluated.assign(pixels, 0);
  std::vector<ShadowSegments> segments;
  std::size_t words = 0;
  for (const LightSamples& samples : batches) {
    segments.emplace_back(scene, light, samples, origin);
    words = std::max(words, static_cast<std::size_t>(samples.mask_words()));
  }
  parallel_for(pixels, grain, [&](std::size_t begin, std::size_t end) {
    const embree::FlushDenormals flush;
    std::vector<uint32_t> mask(words);
    std::vector<float> estimates(batches.size());
    std::vector<Vec4f> faced;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (view.triangle[pixel] == no_triangle) continue;
      bool evaluated = false;
      for (std::size_t b = 0; b < segments.size(); ++b) {
        const std::span<uint32_t> bits(mask.data(), static_cast<std::size_t>(batches[b].mask_words()));
        if (facing) face(light, view.position[pixel].xyz(), batches[b], faced);
        const std::span<const Vec4f> points = facing ? faced : batches[b].points;
        evaluated |= segments[b].blocked(view_sample(view, pixel, origin), points, bits);
        estimates[b] = segments[b].visibility(bits);
      }
      result.evaluated[pixel] = evaluated;
      if (evaluated) summarise(estimates, result.visibility[pixel], result.standard_error[pixel]);
    }
  });
  return result;
}

ReferenceScene::Converged ReferenceScene::converged(const ViewSamplesHost& view, const Light& light, int n,
                                                    uint32_t seed, ReferenceOrigin origin,
                                                    const std::filesystem::path& cache_dir,
                                                    SphereAs sphere) const {
  const bool facing = sphere == SphereAs::disc && light.kind == LightKind::sphere && light.radius > 0;
  std::filesystem::path entry;
  if (!cache_dir.empty()) {
    entry = cache_entry(cache_dir, converged_key(impl_->geometry_hash, view, light, n, seed, origin, sphere));
    if (auto cached = read_cached(entry, view.width, view.height)) {
      cached->mean_standard_error = root_mean_square(cached->standard_error, cached->evaluated);
      return *std::move(cached);
    }
  }
  Converged result =
      converge(impl_->scene, view, light, facing ? make_disc_batches(n, seed) : make_batches(light, n, seed),
               origin, facing);
  result.mean_standard_error = root_mean_square(result.standard_error, result.evaluated);
  if (!entry.empty())
    if (const std::string reason = write_cached(entry, view.width, view.height, result); !reason.empty())
      fmt::print(stderr, "The reference is not cached: {}.\n", reason);
  return result;
}

}  // namespace penumbra
