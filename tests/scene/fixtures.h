// Small meshes, each named for what is right or wrong with it, and helpers for scene files.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "support/temporary_folder.h"

namespace penumbra::test {

inline Mesh mesh_of(std::vector<Vec3f> positions, std::vector<uint32_t> indices) {
  Mesh m;
  m.positions = std::move(positions);
  m.indices = std::move(indices);
  return m;
}

// Two triangles with shared vertices, facing +z.
inline Mesh square() { return mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}); }

// Closed, 8 vertices, wound outwards.
inline Mesh cube() {
  Mesh m;
  for (int i = 0; i < 8; ++i) m.positions.push_back({float(i & 1), float((i >> 1) & 1), float((i >> 2) & 1)});
  m.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return m;
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// The message of the InputError that f throws; fails the test when it throws none.
template <class F>
std::string input_error_of(F f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return "";
}

// A whole scene file around the given members; `animation` may be empty.
inline std::string scene_text(const std::string& meshes, const std::string& instances,
                              const std::string& animation = "") {
  return "{\n  \"name\": \"test\",\n  \"meshes\": {" + meshes + "},\n  \"instances\": [" + instances +
         "],\n  \"lights\": [{\"name\": \"key\", \"kind\": \"rectangle\", \"center\": [0, 5, 0], \"target\": "
         "[0, 0, 0], "
         "\"width\": 1, \"height\": 1}, {\"name\": \"lamp\", \"kind\": \"point\", \"center\": [0, 4, 0]}],\n"
         "  \"cameras\": [{\"name\": \"front\", \"eye\": [0, 1, 5], \"target\": [0, 0, 0]}]" +
         (animation.empty() ? "" : ",\n  \"animation\": " + animation) + "\n}\n";
}

inline Scene load_text(const TemporaryFolder& folder, const std::string& text) {
  const std::filesystem::path path = folder.path() / "test.json";
  write_file(path, text);
  return Scene::load(path.string(), {});
}

#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE(std::string(text).find(part), std::string::npos) << "in: " << (text) << "\nexpected: " << (part)

}  // namespace penumbra::test
