#include "techniques/common/edges_on_device.h"

#include <atomic>

#include "core/parallel.h"

namespace penumbra {
namespace {

void upload_words(gpu::Device& device, gpu::PassRecorder& passes, gpu::Buffer& buffer,
                  const std::vector<uint32_t>& words, const std::string& what) {
  const std::size_t bytes = std::max<std::size_t>(words.size(), 1) * sizeof(uint32_t);
  gpu::ensure(buffer, device, bytes, gpu::Memory::device, what);
  if (!words.empty())
    gpu::upload(passes, "upload_adjacency", buffer, words.data(), words.size() * sizeof(uint32_t));
}

}  // namespace

bool still_welded(const Adjacency& adjacency, const std::vector<Vec3f>& positions) {
  if (adjacency.welded.size() != positions.size()) return false;
  std::atomic<bool> together{true};
  parallel_for(positions.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (!(positions[v] == positions[adjacency.representative[adjacency.welded[v]]])) together = false;
  });
  return together;
}

bool EdgesOnDevice::build(const Case& c, gpu::PassRecorder& passes, const std::string& what) {
  const Frame& frame = *c.frame;
  std::vector<uint32_t> edges, faces;
  bool kept = false;
  passes.host_pass("adjacency", [&] {
    kept = edges_ && !frame.changes.topology &&
           (!frame.changes.positions || still_welded(adjacency_, frame.geometry.positions));
    if (kept) return;
    adjacency_ = build_adjacency(frame.geometry.positions, frame.geometry.indices);
    for (const Edge& e : adjacency_.edges)
      edges.insert(edges.end(), {adjacency_.representative[e.vertex[0]],
                                 adjacency_.representative[e.vertex[1]], e.first_face, e.face_count});
    for (const EdgeFace& f : adjacency_.faces) faces.push_back(2 * f.triangle + (f.sign < 0 ? 1 : 0));
  });
  if (kept) return false;
  upload_words(*c.device, passes, edges_, edges, what + ": edges");
  upload_words(*c.device, passes, faces_, faces, what + ": faces of edges");
  passes.finish();  // the arrays that it copies from end here
  return true;
}

uint64_t EdgesOnDevice::bytes() const {
  return edges_.bytes() + faces_.bytes() +
         (adjacency_.welded.size() + adjacency_.representative.size()) * sizeof(uint32_t) +
         adjacency_.edges.size() * sizeof(Edge) + adjacency_.faces.size() * sizeof(EdgeFace);
}

}  // namespace penumbra
