// Which edges a mesh has and which faces meet there: made once, as long as the mesh only moves.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace penumbra::depth_complexity {

// An edge and two of its faces. The first face runs from vertex a to vertex b. The second one runs from b to
// a, or, where `second_flipped`, from a to b as well. An edge of more than two faces is several records, as
// its weight is a sum over faces; an open edge has its own face twice, the second time flipped.
struct Edge {
  static constexpr uint32_t flipped_bit = 0x80000000U;
  uint32_t a, b, face, second;
  uint32_t second_face() const { return second & ~flipped_bit; }
  bool second_flipped() const { return (second & flipped_bit) != 0; }
  bool open() const { return second_face() == face; }
};

// Memory for large arrays in large pages, where the system has them: most of what a fresh array costs is the
// first touch of each of its pages. Throws std::bad_alloc.
void* allocate_array(std::size_t bytes);
void free_array(void* p);

// Leaves new elements as they are: filling arrays that threads are about to write would be one thread's work.
template <class T>
struct Unfilled : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = Unfilled<U>;
  };
  T* allocate(std::size_t n) { return static_cast<T*>(allocate_array(n * sizeof(T))); }
  void deallocate(T* p, std::size_t) { free_array(p); }
  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class V, class... More>
  void construct(U* p, V&& first, More&&... more) {
    ::new (static_cast<void*>(p)) U(std::forward<V>(first), std::forward<More>(more)...);
  }
};
template <class T>
using Array = std::vector<T, Unfilled<T>>;

struct EdgeTopology {
  Array<uint32_t> mesh_vertex;  // of a welded vertex: a mesh vertex at its position
  Array<uint32_t> corners;      // welded vertices, 3 per triangle
  Array<Edge> edges;            // neighbours in space are neighbours in the list; the long ones come last
  std::size_t open = 0, inconsistent = 0, non_manifold = 0, dropped_faces = 0;  // for the room's counters

  uint64_t bytes() const {
    return (mesh_vertex.capacity() + corners.capacity()) * sizeof(uint32_t) + edges.capacity() * sizeof(Edge);
  }
};

// Welds vertices of exactly equal positions and pairs half-edges by their winding. In parallel, O(n).
EdgeTopology find_edges(const Geometry& geometry);

// Whether vertices that were welded still lie at one place: else the topology has to be found anew.
bool still_welded(const EdgeTopology& topology, const Geometry& geometry);

}  // namespace penumbra::depth_complexity
