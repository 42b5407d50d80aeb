// Every format in a file of a few triangles, written here.
#include "scene/mesh_file.h"

#include <zlib.h>

#include <cstring>

#include "fixtures.h"

namespace penumbra::test {
namespace {

class MeshFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    write_file(folder_ / name, text);
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

Box bounds(const Mesh& m) {
  Box b;
  for (const Vec3f p : m.positions) b.extend(p);
  return b;
}

void expect_square(const Mesh& m) {
  EXPECT_EQ(m.triangle_count(), 2U);
  EXPECT_EQ(bounds(m).lo, (Vec3f{0, 0, 0}));
  EXPECT_EQ(bounds(m).hi, (Vec3f{1, 1, 0}));
  Mesh copy = m;
  const MeshHygiene h = clean(copy, "square");
  EXPECT_EQ(h.open_edges, 4U);
  for (const Vec3f n : copy.normals) EXPECT_NEAR(n.z, 1, 1e-6);
}

// Little-endian binary files, piece by piece.
struct Bytes {
  std::string s;
  template <class T>
  Bytes& put(T v) {
    s.append(reinterpret_cast<const char*>(&v), sizeof v);
    return *this;
  }
  Bytes& raw(const std::string& v) { return s += v, *this; }
  Bytes& shorts(std::initializer_list<int> list) {
    for (const int v : list) put(static_cast<uint16_t>(v));
    return *this;
  }
  Bytes& bytes(std::initializer_list<int> list) {
    for (const int v : list) put(static_cast<uint8_t>(v));
    return *this;
  }
  Bytes& floats(std::initializer_list<float> list) {
    for (const float f : list) put(f);
    return *this;
  }
};

const std::string obj_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string ply_square =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 "
    "2\n3 0 2 3\n";

TEST_F(MeshFile, ObjTrianglesLoadAndShareTheirVertices) {
  const Mesh m = load_mesh(write("a.obj", obj_square + "f 1 2 3\nf 1 3 4\n"));
  expect_square(m);
  EXPECT_EQ(m.positions.size(), 4U);
}

TEST_F(MeshFile, ObjQuadsAreTriangulated) {
  expect_square(load_mesh(write("quad.obj", obj_square + "f 1 2 3 4\n")));
}

TEST_F(MeshFile, ObjNormalsAreKept) {
  const Mesh m = load_mesh(write("n.obj", obj_square + "vn 0 0.6 0.8\nf 1//1 2//1 3//1\n"));
  ASSERT_EQ(m.normals.size(), m.positions.size());
  EXPECT_FLOAT_EQ(m.normals[0].y, 0.6f);
}

TEST_F(MeshFile, ObjGroupsAndObjectsBecomeOneMesh) {
  const Mesh m = load_mesh(write("g.obj", obj_square + "o a\nf 1 2 3\no b\nf 1 3 4\n"));
  expect_square(m);
}

TEST_F(MeshFile, ObjLinesAndPointsAreLeftOut) {
  EXPECT_EQ(load_mesh(write("l.obj", obj_square + "f 1 2 3\nl 1 2\nf 1 3 4\n")).triangle_count(), 2U);
}

TEST_F(MeshFile, PlyLoads) { expect_square(load_mesh(write("a.ply", ply_square))); }

TEST_F(MeshFile, BinaryPlyLoads) {
  Bytes b;
  b.raw(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n");
  b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0}).put<uint8_t>(3).put<int32_t>(0).put<int32_t>(1).put<int32_t>(2);
  EXPECT_EQ(load_mesh(write("b.ply", b.s)).triangle_count(), 1U);
}

std::string gzip(const std::string& text, const std::filesystem::path& path) {
  const gzFile f = gzopen(path.c_str(), "wb");
  gzwrite(f, text.data(), static_cast<unsigned>(text.size()));
  gzclose(f);
  const std::vector<char> bytes = file_bytes(path);
  return {bytes.begin(), bytes.end()};
}

TEST_F(MeshFile, CompressedPlyLoads) {
  gzip(ply_square, folder_ / "a.ply.gz");
  expect_square(load_mesh(folder_ / "a.ply.gz"));
}

TEST_F(MeshFile, TruncatedCompressedPlyIsAnError) {
  std::string text = ply_square;
  for (int i = 0; i < 2000; ++i) text += std::to_string(i * 7919) + "\n";
  const std::string whole = gzip(text, folder_ / "cut.ply.gz");
  write("cut.ply.gz", whole.substr(0, whole.size() / 2));
  EXPECT_CONTAINS(input_error_of([&] { load_mesh(folder_ / "cut.ply.gz"); }), "damaged");
}

TEST_F(MeshFile, OffLoads) {
  expect_square(load_mesh(write("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")));
}

TEST_F(MeshFile, AsciiStlLoadsAndWelds) {
  const std::string facet = "facet normal 0 0 1\nouter loop\n", end = "endloop\nendfacet\n";
  Mesh m = load_mesh(write("a.stl", "solid s\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n" + end +
                                        facet + "vertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n" + end +
                                        "endsolid s\n"));
  expect_square(m);
  EXPECT_EQ(build_adjacency(m.positions, m.indices).representative.size(), 4U);
}

TEST_F(MeshFile, BinaryStlLoads) {
  Bytes b;
  b.raw(std::string(80, ' ')).put<uint32_t>(2);
  b.floats({0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}).put<uint16_t>(0);
  b.floats({0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0}).put<uint16_t>(0);
  expect_square(load_mesh(write("b.stl", b.s)));
}

std::string chunk(uint16_t id, const std::string& body) {
  Bytes b;
  b.put(id).put(static_cast<uint32_t>(body.size() + 6)).raw(body);
  return b.s;
}

TEST_F(MeshFile, ThreeDsLoads) {
  Bytes vertices, faces;
  vertices.put<uint16_t>(4).floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  faces.put<uint16_t>(2);
  faces.shorts({0, 1, 2, 7, 0, 2, 3, 7});
  const std::string mesh = chunk(0x4100, chunk(0x4110, vertices.s) + chunk(0x4120, faces.s));
  const std::string object = chunk(0x4000, std::string("square\0", 7) + mesh);
  const Mesh m = load_mesh(write("a.3ds", chunk(0x4D4D, chunk(0x3D3D, object))));
  EXPECT_EQ(m.triangle_count(), 2U);
  EXPECT_NEAR(bounds(m).diagonal(), std::sqrt(2.0f), 1e-6f);
}

// A square in a buffer of its own, under a node that mirrors and moves it.
std::string gltf(const std::string& node) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + node +
         R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
 "buffers":[{"uri":"a.bin","byteLength":60}],
 "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
              {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]})";
}

TEST_F(MeshFile, GltfLoadsWithItsNodesTransforms) {
  Bytes b;
  b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  b.shorts({0, 1, 2, 0, 2, 3});
  write("a.bin", b.s);
  expect_square(load_mesh(write("a.gltf", gltf(R"({"mesh":0})"))));
  const Mesh moved = load_mesh(write("b.gltf", gltf(R"({"mesh":0,"translation":[0,0,5],"scale":[2,1,1]})")));
  EXPECT_EQ(bounds(moved).lo, (Vec3f{0, 0, 5}));
  EXPECT_EQ(bounds(moved).hi, (Vec3f{2, 1, 5}));
}

TEST_F(MeshFile, MirroringNodeKeepsTheFrontInFront) {
  Bytes b;
  b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  b.shorts({0, 1, 2, 0, 2, 3});
  write("a.bin", b.s);
  Mesh m = load_mesh(write("m.gltf", gltf(R"({"mesh":0,"scale":[-1,1,1]})")));
  EXPECT_EQ(bounds(m).lo.x, -1);
  clean(m, "mirrored");
  for (const Vec3f n : m.normals) EXPECT_NEAR(n.z, 1, 1e-6);
}

// One triangle, two frames: the second is one unit higher.
std::string md2() {
  struct Header {
    char magic[4] = {'I', 'D', 'P', '2'};
    int32_t version = 8, skin_width = 4, skin_height = 4, frame_size = 40 + 3 * 4, skins = 0, vertices = 3,
            texcoords = 1, triangles = 1, commands = 1, frames = 2, skins_at = 68, texcoords_at = 68,
            triangles_at = 72, frames_at = 84, commands_at = 188, end_at = 192;
  } header;
  Bytes b;
  b.put(header).put<int16_t>(0).put<int16_t>(0);
  b.shorts({0, 1, 2, 0, 0, 0});
  for (int frame = 0; frame < 2; ++frame) {
    b.floats({0.5f, 0.5f, 0.5f, 0, 0, static_cast<float>(frame)});
    char name[16] = "frame";
    b.raw(std::string(name, 16));
    b.bytes({0, 0, 0, 0, 10, 0, 0, 0, 0, 20, 0, 0});
  }
  b.put<int32_t>(0);  // drawing commands: none
  return b.s;
}

TEST_F(MeshFile, Md2KeyframesDifferOnlyByTheirMotion) {
  write("a.md2", md2());
  const Mesh first = load_mesh(folder_ / "a.md2", 0), second = load_mesh(folder_ / "a.md2", 1);
  ASSERT_EQ(first.triangle_count(), 1U);
  EXPECT_EQ(first.indices, second.indices);
  ASSERT_EQ(first.positions.size(), second.positions.size());
  for (std::size_t v = 0; v < first.positions.size(); ++v)
    EXPECT_NEAR(length(second.positions[v] - first.positions[v]), 1, 1e-6);
}

TEST_F(MeshFile, NanVertexIsLeftToCleaning) {
  Mesh m = load_mesh(write("nan.obj", "v nan 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n"));
  const MeshHygiene h = clean(m, "nan.obj");
  EXPECT_EQ(h.dropped_not_finite, 1U);
  EXPECT_EQ(m.triangle_count(), 1U);
}

// Either the importer refuses the file or cleaning drops the triangle: never a wrong mesh.
TEST_F(MeshFile, OutOfRangeIndexNeverPassesForATriangle) {
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"r.obj", obj_square + "f 1 2 3\nf 1 3 9\n"},
           {"r.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n"}}) {
    write(name, text);
    try {
      Mesh m = load_mesh(folder_ / name);
      clean(m, name);
      EXPECT_EQ(m.triangle_count(), 1U) << name;
    } catch (const InputError& e) {
      EXPECT_CONTAINS(e.what(), name);
    }
  }
}

TEST_F(MeshFile, OnePointHasNoTriangles) {
  write("point.obj", "v 1 2 3\n");
  const std::string message = input_error_of([&] {
    Mesh m = load_mesh(folder_ / "point.obj");
    clean(m, "point.obj");
  });
  EXPECT_CONTAINS(message, "point.obj");
}

TEST_F(MeshFile, UnknownExtensionListsTheKnownOnes) {
  const std::string message = input_error_of([&] { load_mesh(write("a.xyz", "1 2 3")); });
  EXPECT_CONTAINS(message, "unknown mesh format 'xyz'");
  EXPECT_CONTAINS(message, "ply.gz");
}

TEST_F(MeshFile, MissingAndUnreadableFilesAreNamed) {
  EXPECT_CONTAINS(input_error_of([&] { load_mesh(folder_ / "none.obj"); }), "none.obj: no such mesh file");
  EXPECT_CONTAINS(input_error_of([&] { load_mesh(write("bad.gltf", "{ not json")); }),
                  "bad.gltf: cannot be read as gltf");
  EXPECT_CONTAINS(input_error_of([&] { load_mesh(write("empty.ply", "")); }), "empty.ply");
}

}  // namespace
}  // namespace penumbra::test
