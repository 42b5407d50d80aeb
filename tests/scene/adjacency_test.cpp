#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/parallel.h"
#include "fixtures.h"
#include "scene/generators.h"

namespace penumbra::test {
namespace {

Adjacency adjacency_of(const Mesh& m) { return build_adjacency(m.positions, m.indices); }

std::map<uint32_t, int> edges_by_face_count(const Adjacency& a) {
  std::map<uint32_t, int> counts;
  for (const Edge& e : a.edges) ++counts[e.face_count];
  return counts;
}

int sum_of_signs(const Adjacency& a, const Edge& e) {
  int sum = 0;
  for (uint32_t f = 0; f < e.face_count; ++f) sum += a.faces[e.first_face + f].sign;
  return sum;
}

TEST(Adjacency, CubeHas18EdgesOfTwoOppositeFaces) {
  const Adjacency a = adjacency_of(cube());
  EXPECT_EQ(edges_by_face_count(a), (std::map<uint32_t, int>{{2, 18}}));
  for (const Edge& e : a.edges) {
    EXPECT_LT(e.vertex[0], e.vertex[1]);
    EXPECT_EQ(sum_of_signs(a, e), 0);
  }
}

TEST(Adjacency, UnsharedVerticesAreWeldedByPosition) {
  const Mesh shared = cube();
  Mesh soup;
  for (const uint32_t i : shared.indices) {
    soup.indices.push_back(static_cast<uint32_t>(soup.positions.size()));
    soup.positions.push_back(shared.positions[i]);
  }
  const Adjacency a = adjacency_of(soup);
  EXPECT_EQ(a.representative.size(), 8U);
  EXPECT_EQ(edges_by_face_count(a), (std::map<uint32_t, int>{{2, 18}}));
  for (uint32_t v = 0; v < soup.positions.size(); ++v)
    EXPECT_EQ(soup.positions[a.representative[a.welded[v]]], soup.positions[v]);
}

TEST(Adjacency, MinusZeroEqualsZero) {
  Mesh m = square();
  m.positions.push_back({-0.0f, -0.0f, -0.0f});
  m.positions.push_back({1, 1, -0.0f});
  m.indices = {0, 1, 2, 4, 5, 3};
  const Adjacency a = adjacency_of(m);
  EXPECT_EQ(a.representative.size(), 4U);
  EXPECT_EQ(edges_by_face_count(a), (std::map<uint32_t, int>{{1, 4}, {2, 1}}));
}

TEST(Adjacency, NearlyEqualPositionsStayApart) {
  Mesh m = square();
  m.positions.push_back({std::nextafter(1.0f, 2.0f), 1, 0});
  m.indices = {0, 1, 2, 0, 4, 3};
  EXPECT_EQ(adjacency_of(m).representative.size(), 5U);
}

TEST(Adjacency, MobiusStripHasOneInconsistentEdge) {
  // Five quads in a ring with a half turn in the last.
  Mesh m;
  for (int i = 0; i < 5; ++i)
    for (float h : {0.0f, 1.0f})
      m.positions.push_back({std::cos(1.2566f * float(i)), h, std::sin(1.2566f * float(i))});
  for (uint32_t i = 0; i < 5; ++i) {
    const uint32_t a = 2 * i, b = a + 1;
    const uint32_t c = i < 4 ? a + 2 : 1, d = i < 4 ? a + 3 : 0;
    m.indices.insert(m.indices.end(), {a, c, b, b, c, d});
  }
  const Adjacency a = adjacency_of(m);
  int inconsistent = 0;
  for (const Edge& e : a.edges) inconsistent += e.face_count == 2 && sum_of_signs(a, e) != 0;
  EXPECT_EQ(inconsistent, 1);
  EXPECT_EQ(edges_by_face_count(a), (std::map<uint32_t, int>{{1, 10}, {2, 10}}));
}

TEST(Adjacency, TJunctionLeavesItsEdgesOpen) {
  // One long edge (0-1) against two halves that meet at 2.
  const Mesh m =
      mesh_of({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}}, {0, 1, 3, 0, 4, 2, 2, 4, 1});
  const Adjacency a = adjacency_of(m);
  EXPECT_EQ(edges_by_face_count(a), (std::map<uint32_t, int>{{1, 7}, {2, 1}}));
}

TEST(Adjacency, NonManifoldEdgeListsAllItsFaces) {
  const Mesh m =
      mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}}, {0, 1, 2, 1, 0, 3, 0, 1, 4});
  const Adjacency a = adjacency_of(m);
  const auto e =
      std::find_if(a.edges.begin(), a.edges.end(), [](const Edge& x) { return x.face_count == 3; });
  ASSERT_NE(e, a.edges.end());
  std::set<std::pair<uint32_t, int>> faces;
  for (uint32_t f = 0; f < 3; ++f)
    faces.insert({a.faces[e->first_face + f].triangle, a.faces[e->first_face + f].sign});
  EXPECT_EQ(faces, (std::set<std::pair<uint32_t, int>>{{0, 1}, {1, -1}, {2, 1}}));
}

TEST(Adjacency, DegenerateTriangleHasNoEdgeToItself) {
  const Adjacency a = adjacency_of(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {0, 1, 2}));
  ASSERT_EQ(a.edges.size(), 1U);
  EXPECT_EQ(a.edges[0].face_count, 2U);
  EXPECT_EQ(sum_of_signs(a, a.edges[0]), 0);
}

TEST(Adjacency, NothingGivesNothing) {
  const Adjacency a = build_adjacency({}, {});
  EXPECT_TRUE(a.edges.empty() && a.faces.empty() && a.representative.empty());
}

// Against a map of edges, on a soup of random triangles with many coincidences.
TEST(Adjacency, AgreesWithAMapOfEdgesOnRandomSoup) {
  std::mt19937 random(5);
  Mesh m;
  for (int i = 0; i < 60000; ++i) {
    m.positions.push_back({float(random() % 20), float(random() % 20), float(random() % 20)});
    m.indices.push_back(static_cast<uint32_t>(random() % m.positions.size()));
  }
  const auto position = [&](uint32_t i) {
    const Vec3f p = m.positions[i];
    return std::array<float, 3>{p.x, p.y, p.z};
  };
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, std::multiset<uint32_t>> expected;
  for (std::size_t t = 0; t < m.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      auto a = position(m.indices[3 * t + k]), b = position(m.indices[3 * t + (k + 1) % 3]);
      if (a == b) continue;
      if (b < a) std::swap(a, b);
      expected[{a, b}].insert(static_cast<uint32_t>(t));
    }
  const Adjacency adjacency = adjacency_of(m);
  ASSERT_EQ(adjacency.edges.size(), expected.size());
  for (const Edge& e : adjacency.edges) {
    auto a = position(adjacency.representative[e.vertex[0]]),
         b = position(adjacency.representative[e.vertex[1]]);
    if (b < a) std::swap(a, b);
    std::multiset<uint32_t> faces;
    for (uint32_t f = 0; f < e.face_count; ++f) faces.insert(adjacency.faces[e.first_face + f].triangle);
    ASSERT_EQ(faces, (expected[{a, b}]));
  }
}

TEST(Adjacency, SignsSayWhichWayTheTriangleRuns) {
  const Mesh m = generate("torus_knot", {});
  const Adjacency a = adjacency_of(m);
  for (const Edge& e : a.edges)
    for (uint32_t f = e.first_face; f < e.first_face + e.face_count; ++f) {
      const uint32_t* corner = &m.indices[3 * std::size_t{a.faces[f].triangle}];
      bool forward = false;
      for (int k = 0; k < 3; ++k)
        forward |= a.welded[corner[k]] == e.vertex[0] && a.welded[corner[(k + 1) % 3]] == e.vertex[1];
      ASSERT_EQ(forward, a.faces[f].sign == 1);
    }
}

}  // namespace
}  // namespace penumbra::test
