#include "scene/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <zlib.h>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <bit>
#include <cctype>
#include <mutex>
#include <unordered_map>

#include "core/error.h"

namespace penumbra {
namespace {

const std::vector<std::string>& known_extensions() {
  static const std::vector<std::string> list = {"obj", "ply", "ply.gz", "stl", "off",
                                                "md2", "3ds", "gltf",   "glb"};
  return list;
}

std::string lower(std::string s) {
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

// The file's extension, which names the format; ".gz" is kept with the one before it.
std::string checked_extension(const std::filesystem::path& path) {
  std::string ext = lower(path.extension().string());
  if (ext == ".gz") ext = lower(path.stem().extension().string()) + ext;
  if (!ext.empty()) ext.erase(0, 1);
  for (const std::string& known : known_extensions())
    if (ext == known) return ext;
  std::string list;
  for (const std::string& known : known_extensions()) list += (list.empty() ? "" : ", ") + known;
  throw InputError(fmt::format("{}: unknown mesh format '{}'. Known: {}.", path.string(), ext, list));
}

std::string inflate_file(const std::filesystem::path& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  if (!file) throw InputError(fmt::format("{}: cannot be opened", path.string()));
  std::string text;
  std::vector<char> block(1U << 20U);
  int n = 0;
  while ((n = gzread(file, block.data(), static_cast<unsigned>(block.size()))) > 0)
    text.append(block.data(), static_cast<std::size_t>(n));
  int code = Z_OK;
  const std::string why = gzerror(file, &code);
  gzclose(file);
  // A stream cut short ends without Z_OK (Z_BUF_ERROR), which must not pass for a smaller mesh.
  if (n < 0 || (code != Z_OK && code != Z_STREAM_END))
    throw InputError(fmt::format("{}: the compressed data is damaged ({})", path.string(), why));
  return text;
}

Mat4d matrix(const aiMatrix4x4& m) {
  Mat4d out;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned r = 0; r < 4; ++r) out[static_cast<int>(c)][static_cast<int>(r)] = double{m[r][c]};
  return out;
}

double determinant3(const Mat4d& m) { return dot(m[0].xyz(), cross(m[1].xyz(), m[2].xyz())); }

Vec3f vec(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Appends one submesh. An index out of range stays out of range after the offset, so that clean() drops and
// counts it.
void append(Mesh& out, const aiMesh& in, const Mat4d& world_from_mesh) {
  const auto base = static_cast<uint32_t>(out.positions.size());
  const bool identity = world_from_mesh == Mat4d{};
  const bool mirrored = determinant3(world_from_mesh) < 0;
  Mat4d linear = world_from_mesh;
  linear[3] = {0, 0, 0, 1};
  const bool singular = determinant3(world_from_mesh) == 0;
  const Mat4d to_normal = identity || singular ? Mat4d{} : inverse(linear);
  for (unsigned v = 0; v < in.mNumVertices; ++v) {
    const Vec3f p = vec(in.mVertices[v]);
    out.positions.push_back(identity ? p : Vec3f(transform_point(world_from_mesh, Vec3d(p))));
    Vec3f n = in.HasNormals() ? vec(in.mNormals[v]) : Vec3f{};  // zero: clean() fills it
    if (!identity) {
      const Vec3d d(n);
      n = Vec3f(Vec3d{dot(to_normal[0].xyz(), d), dot(to_normal[1].xyz(), d), dot(to_normal[2].xyz(), d)});
    }
    out.normals.push_back(n);
  }
  for (unsigned f = 0; f < in.mNumFaces; ++f) {
    const aiFace& face = in.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines cast no shadow
    uint32_t corner[3];
    for (unsigned k = 0; k < 3; ++k)
      corner[k] = face.mIndices[k] < in.mNumVertices ? base + face.mIndices[k] : UINT32_MAX;
    if (mirrored) std::swap(corner[1], corner[2]);
    out.indices.insert(out.indices.end(), corner, corner + 3);
  }
}

void append_node(Mesh& out, const aiScene& scene, const aiNode& node, const Mat4d& parent) {
  const Mat4d transform = parent * matrix(node.mTransformation);
  for (unsigned m = 0; m < node.mNumMeshes; ++m) append(out, *scene.mMeshes[node.mMeshes[m]], transform);
  for (unsigned c = 0; c < node.mNumChildren; ++c) append_node(out, scene, *node.mChildren[c], transform);
}

// While it lives, errors that the importer logs but carries on after. The OFF reader moves an index that is
// out of range to the last vertex and says so only there: the wrong triangle would pass for a right one.
class ImportErrors {
 public:
  ImportErrors() : lock_(mutex()) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(&text_),
                                               Assimp::Logger::Err);  // the logger deletes it
  }
  ~ImportErrors() { Assimp::DefaultLogger::kill(); }
  ImportErrors(const ImportErrors&) = delete;
  ImportErrors& operator=(const ImportErrors&) = delete;
  bool index_out_of_range() const { return text_.find("index is out of range") != std::string::npos; }

 private:
  struct Stream : Assimp::LogStream {
    explicit Stream(std::string* text) : out(text) {}
    void write(const char* message) override { *out += message; }
    std::string* out;
  };
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  std::lock_guard<std::mutex> lock_;  // the importer's logger is one for the whole process
  std::string text_;
};

struct VertexKey {
  uint32_t bits[6];
  bool operator==(const VertexKey&) const = default;
};
struct VertexKeyHash {
  std::size_t operator()(const VertexKey& k) const {
    uint64_t h = 0x9e3779b97f4a7c15U;
    for (const uint32_t b : k.bits) h = (h ^ b) * 0xff51afd7ed558ccdU, h ^= h >> 32U;
    return static_cast<std::size_t>(h);
  }
};

// The importer gives each face corners of its own; corners that agree in position and normal to the last bit
// are one vertex again. Nothing is joined by a tolerance.
void share_equal_vertices(Mesh& mesh) {
  std::unordered_map<VertexKey, uint32_t, VertexKeyHash> known;
  known.reserve(mesh.positions.size());
  std::vector<uint32_t> number(mesh.positions.size());
  uint32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    const Vec3f p = mesh.positions[v], n = mesh.normals[v];
    VertexKey key{};
    for (int k = 0; k < 3; ++k)
      key.bits[k] = std::bit_cast<uint32_t>(p[k]), key.bits[k + 3] = std::bit_cast<uint32_t>(n[k]);
    const auto [it, is_new] = known.try_emplace(key, kept);
    number[v] = it->second;
    if (!is_new) continue;
    mesh.positions[kept] = p, mesh.normals[kept] = n;
    ++kept;
  }
  mesh.positions.resize(kept), mesh.normals.resize(kept);
  for (uint32_t& i : mesh.indices)
    if (i < number.size()) i = number[i];
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& path, int frame) {
  const std::string ext = checked_extension(path);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(fmt::format("{}: no such mesh file", path.string()));
  const ImportErrors errors;
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_GLOBAL_KEYFRAME, frame);
  const aiScene* scene = nullptr;
  if (ext == "ply.gz") {
    const std::string text = inflate_file(path);
    scene = importer.ReadFileFromMemory(text.data(), text.size(), aiProcess_Triangulate, "ply");
  } else {
    scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  }
  if (!scene || !scene->mRootNode)
    throw InputError(
        fmt::format("{}: cannot be read as {}: {}", path.string(), ext, importer.GetErrorString()));
  if (errors.index_out_of_range())
    throw InputError(fmt::format("{}: a face has a vertex index out of range", path.string()));
  Mesh mesh;
  append_node(mesh, *scene, *scene->mRootNode, Mat4d{});
  // Keyframes must number their vertices alike, whatever positions happen to coincide in one of them.
  if (ext != "md2") share_equal_vertices(mesh);
  return mesh;
}

}  // namespace penumbra
