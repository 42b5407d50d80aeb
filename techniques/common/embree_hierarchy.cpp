#include "techniques/common/embree_hierarchy.h"

#include <fmt/format.h>

#include <cassert>
#include <cstring>

#include "core/error.h"

namespace penumbra {
namespace {

bool count_bytes(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

RTCBuildQuality embree_quality(HierarchyQuality quality) {
  switch (quality) {
    case HierarchyQuality::low:
      return RTC_BUILD_QUALITY_LOW;
    case HierarchyQuality::high:
      return RTC_BUILD_QUALITY_HIGH;
    case HierarchyQuality::medium:
    case HierarchyQuality::refit:
      break;  // refitting is the geometry's property; the first build is of medium quality
  }
  return RTC_BUILD_QUALITY_MEDIUM;
}

}  // namespace

EmbreeHierarchy::EmbreeHierarchy(HierarchyQuality quality, bool dynamic, bool robust)
    : quality_(quality), device_(rtcNewDevice(nullptr)) {
  if (!device_) throw PointError("Embree cannot make a device.");
  rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, embree_quality(quality));
  // The dynamic flag lets Embree keep what it needs for the next build; for `medium` and `high` it would only
  // forbid the better hierarchies.
  const bool keep = dynamic && (quality == HierarchyQuality::low || quality == HierarchyQuality::refit);
  rtcSetSceneFlags(scene_,
                   static_cast<RTCSceneFlags>((keep ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE) |
                                              (robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE)));
}

EmbreeHierarchy::~EmbreeHierarchy() {
  if (triangles_) rtcReleaseGeometry(triangles_);
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeHierarchy::check() const {
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw PointError(fmt::format("Embree cannot build the hierarchy over {} triangles (error {}{}).",
                                 triangle_count_, static_cast<int>(error),
                                 error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : ""));
}

void EmbreeHierarchy::load(const Geometry& geometry) {
  if (triangles_) {
    rtcDetachGeometry(scene_, 0);
    rtcReleaseGeometry(triangles_);
  }
  vertex_count_ = geometry.positions.size(), triangle_count_ = geometry.triangle_count();
  triangles_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (quality_ == HierarchyQuality::refit) rtcSetGeometryBuildQuality(triangles_, RTC_BUILD_QUALITY_REFIT);
  // Embree's own buffers: they carry the padding that its vector loads need.
  vertices_ = rtcSetNewGeometryBuffer(triangles_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                      vertex_count_);
  void* indices = rtcSetNewGeometryBuffer(triangles_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), triangle_count_);
  check();
  std::memcpy(vertices_, geometry.positions.data(), vertex_count_ * sizeof(Vec3f));
  std::memcpy(indices, geometry.indices.data(), 3 * triangle_count_ * sizeof(uint32_t));
  rtcCommitGeometry(triangles_);
  rtcAttachGeometryByID(scene_, triangles_, 0);
}

bool EmbreeHierarchy::fits(const Geometry& geometry) const {
  return triangles_ && geometry.positions.size() == vertex_count_ &&
         geometry.triangle_count() == triangle_count_;
}

void EmbreeHierarchy::move(const Geometry& geometry) {
  assert(fits(geometry));
  std::memcpy(vertices_, geometry.positions.data(), vertex_count_ * sizeof(Vec3f));
  rtcUpdateGeometryBuffer(triangles_, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(triangles_);
}

void EmbreeHierarchy::commit() {
  rtcCommitScene(scene_);
  check();
}

int EmbreeHierarchy::native_packet() const {
  const auto has = [&](RTCDeviceProperty property) { return rtcGetDeviceProperty(device_, property) != 0; };
  if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
  return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

}  // namespace penumbra
