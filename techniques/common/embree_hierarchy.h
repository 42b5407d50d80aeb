// Embree's device and its hierarchy over one scene's triangles, built anew or refitted.
#pragma once
#include <atomic>
#include <cstdint>

#include "embree/embree.h"
#include "scene/scene.h"

namespace penumbra {

enum class HierarchyQuality { low, medium, high, refit };

class EmbreeHierarchy {
 public:
  EmbreeHierarchy(HierarchyQuality quality, bool dynamic, bool robust);
  ~EmbreeHierarchy();
  EmbreeHierarchy(const EmbreeHierarchy&) = delete;
  EmbreeHierarchy& operator=(const EmbreeHierarchy&) = delete;

  // New topology: replaces what was there. Throws PointError when Embree is out of memory.
  void load(const Geometry& geometry);
  // The same topology, moved. Needs an earlier load() of as many vertices.
  void move(const Geometry& geometry);
  bool fits(const Geometry& geometry) const;
  // Builds or refits after load() or move().
  void commit();

  // The widest packet (4, 8 or 16 rays) that Embree traces with one vector on this processor.
  int native_packet() const;

  RTCScene scene() const { return scene_; }
  // What Embree holds now: hierarchy, vertex and index copies.
  uint64_t bytes() const { return static_cast<uint64_t>(bytes_.load(std::memory_order_relaxed)); }

 private:
  void check() const;

  HierarchyQuality quality_;
  std::atomic<int64_t> bytes_{0};
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCGeometry triangles_ = nullptr;
  void* vertices_ = nullptr;
  std::size_t vertex_count_ = 0, triangle_count_ = 0;
};

}  // namespace penumbra
