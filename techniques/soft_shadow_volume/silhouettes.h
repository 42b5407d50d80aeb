// The silhouette edges that a point of the light sees, found on the device.
#pragma once
#include "techniques/common/edges_on_device.h"
#include "techniques/common/prefix_scan.h"
#include "techniques/soft_shadow_volume/area_light.h"

namespace penumbra::soft_shadow_volume {

class Silhouettes {
 public:
  void setup(gpu::Device& device);
  // Passes "adjacency", "casters" (host), "upload_adjacency". Throws PointError when the scene has no closed
  // meshes any more.
  void build(const Case& c, gpu::PassRecorder& passes);
  // As a part of the light sees them from its pivot. Passes "turned", "silhouettes".
  void extract(const Case& c, const Part& part, gpu::PassRecorder& passes);

  uint32_t count() const { return count_; }          // of silhouette edges
  uint32_t near_caps() const { return near_caps_; }  // vertices of casters that the near plane may cut
  int eye_volumes() const { return eye_volumes_; }   // that hold the eye
  uint32_t edges() const { return edges_.count(); }
  const gpu::Buffer& list() const { return list_; }
  const gpu::Buffer& extraction() const { return extraction_; }
  uint64_t bytes() const;

 private:
  void read(gpu::PassRecorder& passes);

  EdgesOnDevice edges_;
  PrefixScan scan_;
  gpu::ComputePipeline turned_pipeline_, mark_pipeline_, write_pipeline_;
  gpu::Buffer casts_, turned_, marks_, places_, scratch_, extraction_, list_, read_back_;
  uint32_t count_ = 0, near_caps_ = 0;
  int eye_volumes_ = 0;
};

}  // namespace penumbra::soft_shadow_volume
