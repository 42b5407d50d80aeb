#include "scene/subdivision.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <queue>

#include "core/error.h"

namespace penumbra {
namespace {

constexpr std::size_t most_triangles = std::size_t{1} << 28;

// What is left of a mesh once vertices of equal position are one.
struct Welded {
  std::vector<Vec3d> positions;
  std::vector<uint32_t> indices;
  Adjacency adjacency;
};

Welded welded(const Mesh& mesh) {
  Welded out;
  out.adjacency = build_adjacency(mesh.positions, mesh.indices);
  for (const uint32_t v : out.adjacency.representative) out.positions.push_back(Vec3d(mesh.positions[v]));
  for (const uint32_t i : mesh.indices) out.indices.push_back(out.adjacency.welded[i]);
  return out;
}

uint32_t opposite(const Welded& w, const Edge& e, uint32_t triangle) {
  for (int k = 0; k < 3; ++k) {
    const uint32_t v = w.indices[3 * std::size_t{triangle} + static_cast<std::size_t>(k)];
    if (v != e.vertex[0] && v != e.vertex[1]) return v;
  }
  return e.vertex[0];
}

// Where the vertices of the coarse mesh go.
std::vector<Vec3d> moved_vertices(const Welded& w) {
  struct Ring {
    Vec3d all, creases;
    uint32_t edges = 0, crease_edges = 0;
  };
  std::vector<Ring> rings(w.positions.size());
  for (const Edge& e : w.adjacency.edges)
    for (int k = 0; k < 2; ++k) {
      Ring& ring = rings[e.vertex[k]];
      const Vec3d other = w.positions[e.vertex[1 - k]];
      ring.all += other, ++ring.edges;
      if (e.face_count != 2) ring.creases += other, ++ring.crease_edges;
    }
  std::vector<Vec3d> out = w.positions;
  for (std::size_t v = 0; v < out.size(); ++v) {
    const Ring& ring = rings[v];
    if (ring.crease_edges == 2) {
      out[v] = w.positions[v] * 0.75 + ring.creases * 0.125;
    } else if (ring.crease_edges == 0 && ring.edges > 0) {
      const double n = ring.edges, c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
      const double beta = (0.625 - c * c) / n;
      out[v] = w.positions[v] * (1 - n * beta) + ring.all * beta;
    }
  }
  return out;
}

Vec3d edge_point(const Welded& w, const Edge& e) {
  const Vec3d ends = w.positions[e.vertex[0]] + w.positions[e.vertex[1]];
  if (e.face_count != 2) return ends * 0.5;
  const uint32_t a = opposite(w, e, w.adjacency.faces[e.first_face].triangle),
                 b = opposite(w, e, w.adjacency.faces[e.first_face + 1].triangle);
  return ends * 0.375 + (w.positions[a] + w.positions[b]) * 0.125;
}

// A triangle mesh whose edges are split one after the other.
class Splitter {
 public:
  Splitter(const Welded& w, const Mesh& mesh) : indices_(w.indices) {
    for (const uint32_t v : w.adjacency.representative) positions_.push_back(mesh.positions[v]);
    for (const Edge& e : w.adjacency.edges) {
      SplitEdge edge{{e.vertex[0], e.vertex[1]}, {none, none}, e.face_count};
      for (uint32_t f = 0; f < e.face_count && e.face_count <= 2; ++f)
        edge.face[f] = w.adjacency.faces[e.first_face + f].triangle;
      add(edge);
    }
    triangle_edges_.resize(indices_.size());
    for (uint32_t id = 0; id < edges_.size(); ++id)
      for (uint32_t f = 0; f < edges_[id].faces; ++f)
        slot(w.adjacency.faces[w.adjacency.edges[id].first_face + f].triangle, edges_[id]) = id;
  }

  std::size_t triangle_count() const { return indices_.size() / 3; }
  // False where there is no edge with so many faces.
  bool split_longest(uint32_t faces) {
    auto& queue = faces == 2 ? inner_ : outer_;
    while (!queue.empty()) {
      const auto [length, minus_id] = queue.top();
      queue.pop();
      const auto id = static_cast<uint32_t>(-minus_id);
      if (length != squared_length(edges_[id])) continue;  // it has been cut since
      split(id);
      return true;
    }
    return false;
  }
  Mesh mesh() && {
    Mesh out;
    out.positions = std::move(positions_), out.indices = std::move(indices_);
    return out;
  }

 private:
  static constexpr uint32_t none = UINT32_MAX;
  struct SplitEdge {
    uint32_t vertex[2];
    uint32_t face[2];  // none for edges with more than two, which are never split
    uint32_t faces;
  };

  double squared_length(const SplitEdge& e) const {
    const Vec3d d = Vec3d(positions_[e.vertex[0]]) - Vec3d(positions_[e.vertex[1]]);
    return dot(d, d);
  }
  uint32_t add(const SplitEdge& e) {
    edges_.push_back(e);
    enqueue(static_cast<uint32_t>(edges_.size() - 1));
    return static_cast<uint32_t>(edges_.size() - 1);
  }
  // Of edges as long the oldest goes first, so that the result is the same everywhere.
  void enqueue(uint32_t id) {
    const SplitEdge& e = edges_[id];
    if (e.faces == 2) inner_.emplace(squared_length(e), -int64_t{id});
    if (e.faces == 1) outer_.emplace(squared_length(e), -int64_t{id});
  }
  // Where a triangle keeps the number of its edge: the k-th runs from corner k to the next.
  uint32_t& slot(uint32_t triangle, const SplitEdge& e) {
    const std::size_t first = 3 * std::size_t{triangle};
    for (std::size_t k = 0; k < 3; ++k)
      if (is_edge(e, indices_[first + k], indices_[first + (k + 1) % 3])) return triangle_edges_[first + k];
    throw std::logic_error("split_to: an edge is not its triangle's");
  }

  // The old number keeps the half at vertex[0].
  void split(uint32_t id) {
    const SplitEdge old = edges_[id];
    const auto middle = static_cast<uint32_t>(positions_.size());
    positions_.push_back(Vec3f((Vec3d(positions_[old.vertex[0]]) + Vec3d(positions_[old.vertex[1]])) * 0.5));
    edges_[id].vertex[1] = middle;
    const auto far_half = static_cast<uint32_t>(edges_.size());
    edges_.push_back({{middle, old.vertex[1]}, {none, none}, old.faces});
    for (uint32_t f = 0; f < old.faces; ++f)
      edges_[far_half].face[f] = split_face(old, old.face[f], id, far_half);
    enqueue(id), enqueue(far_half);
  }

  // Cuts one face of `old` in two; the face itself keeps the half at vertex[0]. Returns the other half.
  uint32_t split_face(const SplitEdge& old, uint32_t face, uint32_t near_half, uint32_t far_half) {
    const auto middle = static_cast<uint32_t>(positions_.size() - 1);
    const auto other = static_cast<uint32_t>(triangle_count());
    const std::size_t first = 3 * std::size_t{face};
    std::size_t k = 0;  // corner k is vertex[0], as seen along the winding or against it
    while (!is_edge(old, indices_[first + k], indices_[first + (k + 1) % 3])) ++k;
    const bool along = indices_[first + k] == old.vertex[0];
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const uint32_t a = indices_[first + k], b = indices_[first + l], tip = indices_[first + m];
    const uint32_t edge_b = triangle_edges_[first + l], edge_a = triangle_edges_[first + m];  // b-tip, tip-a
    const uint32_t cut = add({{middle, tip}, {face, other}, 2});
    const uint32_t half_a = along ? near_half : far_half, half_b = along ? far_half : near_half;
    // (a, middle, tip) and (middle, b, tip), the one at vertex[0] under the old number.
    const uint32_t corners[2][3] = {{a, middle, tip}, {middle, b, tip}};
    const uint32_t sides[2][3] = {{half_a, cut, edge_a}, {half_b, edge_b, cut}};
    const int near = along ? 0 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      indices_[first + i] = corners[near][i], triangle_edges_[first + i] = sides[near][i];
      indices_.push_back(corners[1 - near][i]), triangle_edges_.push_back(sides[1 - near][i]);
    }
    SplitEdge& handed_over = edges_[near == 0 ? edge_b : edge_a];
    for (uint32_t& f : handed_over.face)
      if (f == face) f = other;
    return other;
  }
  static bool is_edge(const SplitEdge& e, uint32_t a, uint32_t b) {
    return (a == e.vertex[0] && b == e.vertex[1]) || (a == e.vertex[1] && b == e.vertex[0]);
  }

  std::vector<Vec3f> positions_;
  std::vector<uint32_t> indices_, triangle_edges_;
  std::vector<SplitEdge> edges_;
  std::priority_queue<std::pair<double, int64_t>> inner_, outer_;
};

}  // namespace

Mesh loop_subdivided(const Mesh& mesh) {
  const Welded w = welded(mesh);
  Mesh out;
  for (const Vec3d p : moved_vertices(w)) out.positions.push_back(Vec3f(p));
  const auto old_vertices = static_cast<uint32_t>(out.positions.size());
  std::vector<uint32_t> middle(w.indices.size());  // of triangle t's edges, as the k-th runs on from corner k
  for (std::size_t id = 0; id < w.adjacency.edges.size(); ++id) {
    const Edge& e = w.adjacency.edges[id];
    out.positions.push_back(Vec3f(edge_point(w, e)));
    for (uint32_t f = 0; f < e.face_count; ++f) {
      const std::size_t first = 3 * std::size_t{w.adjacency.faces[e.first_face + f].triangle};
      for (std::size_t k = 0; k < 3; ++k) {
        const uint32_t a = w.indices[first + k], b = w.indices[first + (k + 1) % 3];
        if (std::min(a, b) == e.vertex[0] && std::max(a, b) == e.vertex[1])
          middle[first + k] = old_vertices + static_cast<uint32_t>(id);
      }
    }
  }
  for (std::size_t i = 0; i < w.indices.size(); i += 3) {
    const uint32_t a = w.indices[i], b = w.indices[i + 1], c = w.indices[i + 2];
    const uint32_t ab = middle[i], bc = middle[i + 1], ca = middle[i + 2];
    for (const uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) out.indices.push_back(v);
  }
  return out;
}

Mesh split_to(const Mesh& mesh, std::size_t target, const std::string& place) {
  Splitter splitter(welded(mesh), mesh);
  if (target < splitter.triangle_count())
    throw InputError(fmt::format("{}: found target_triangles = {}, expected at least the {} that there are.",
                                 place, target, splitter.triangle_count()));
  while (splitter.triangle_count() < target)
    if (!splitter.split_longest(target - splitter.triangle_count() > 1 ? 2 : 1))
      throw InputError(fmt::format("{}: target_triangles = {} cannot be met: the mesh has {}, and {}.", place,
                                   target, splitter.triangle_count(),
                                   target - splitter.triangle_count() > 1
                                       ? "no edge with two faces to split"
                                       : "without open edges the number stays even"));
  return std::move(splitter).mesh();
}

Mesh subdivided(const Mesh& mesh, const Subdivision& how, const std::string& place) {
  const std::size_t after = mesh.triangle_count() << (2 * how.loop);
  if (std::max(after, how.target_triangles) > most_triangles)
    throw InputError(fmt::format("{}: subdivision would make {} triangles, at most {} are possible.", place,
                                 std::max(after, how.target_triangles), most_triangles));
  Mesh out = mesh;
  for (int step = 0; step < how.loop; ++step) out = loop_subdivided(out);
  return how.target_triangles > 0 ? split_to(out, how.target_triangles, place) : out;
}

}  // namespace penumbra
