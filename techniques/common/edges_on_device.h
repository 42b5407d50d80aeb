// Which edges have which triangles, on the device: what silhouettes are found from, whatever the light.
#pragma once
#include "technique/technique.h"

namespace penumbra {

// Whether `adjacency` still welds only vertices that lie at one place.
bool still_welded(const Adjacency& adjacency, const std::vector<Vec3f>& positions);

class EdgesOnDevice {
 public:
  // Topology alone, kept while welded vertices move together. Passes "adjacency" (host), "upload_adjacency".
  // True when it was made anew.
  bool build(const Case& c, gpu::PassRecorder& passes, const std::string& what);

  uint32_t count() const { return static_cast<uint32_t>(adjacency_.edges.size()); }
  const Adjacency& adjacency() const { return adjacency_; }
  // Per edge 4 words: two vertices, first face, face count.
  const gpu::Buffer& edges() const { return edges_; }
  // Per face of an edge: triangle * 2, + 1 when it runs the edge backwards.
  const gpu::Buffer& faces() const { return faces_; }
  // Host and device.
  uint64_t bytes() const;

 private:
  Adjacency adjacency_;
  gpu::Buffer edges_, faces_;
};

}  // namespace penumbra
