#include "reference/cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <fstream>

#include "core/hash.h"

namespace penumbra {
namespace {

// Raise it when the reference's own computation changes, so that old entries are not taken for new ones.
constexpr uint32_t version = 2;

struct Header {
  char magic[8] = {'P', 'N', 'B', 'R', 'R', 'E', 'F', '\n'};
  uint32_t version = penumbra::version, width = 0, height = 0, reserved = 0;
  uint64_t payload_bytes = 0;
  char checksum[32] = {};  // of the entry's name, which is its key, and the payload
};
static_assert(sizeof(Header) == 64);

// visibility, standard_error (float each), evaluated (byte): per pixel.
constexpr std::size_t bytes_per_pixel = 9;

Header header_for(const std::filesystem::path& entry, int width, int height, const std::string& payload) {
  Header h;
  h.width = static_cast<uint32_t>(width), h.height = static_cast<uint32_t>(height);
  h.payload_bytes = payload.size();
  const std::string checksum =
      Hasher().text(entry.filename().string()).bytes(payload.data(), payload.size()).hex();
  std::memcpy(h.checksum, checksum.data(), sizeof h.checksum);
  return h;
}

template <class T>
void append(std::string& payload, const std::vector<T>& values) {
  payload.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
const char* extract(const char* from, std::size_t count, std::vector<T>& values) {
  values.resize(count);
  std::memcpy(values.data(), from, count * sizeof(T));
  return from + count * sizeof(T);
}

std::optional<std::string> read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// Empty when the bytes are an entry of this size, else what is wrong with them.
std::string defect(const std::filesystem::path& entry, const std::string& content, int width, int height) {
  const std::size_t payload_bytes =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * bytes_per_pixel;
  if (content.size() < sizeof(Header)) return "is truncated";
  const Header expected = header_for(entry, width, height, content.substr(sizeof(Header)));
  Header found;
  std::memcpy(&found, content.data(), sizeof found);
  if (std::memcmp(found.magic, expected.magic, sizeof found.magic) != 0) return "is no reference";
  if (found.version != version) return "is of another version";
  if (found.width != expected.width || found.height != expected.height) return "is of another size";
  if (found.payload_bytes != payload_bytes) return "is damaged";
  if (content.size() - sizeof(Header) != payload_bytes) return "is truncated";
  if (std::memcmp(found.checksum, expected.checksum, sizeof found.checksum) != 0)
    return "is damaged, or another one's";
  return "";
}

void hash_light(Hasher& hash, const Light& light) {
  hash.value(static_cast<uint32_t>(light.kind));
  for (const Vec3f& v : {light.center, light.direction, light.edge_u, light.edge_v})
    hash.value(v.x).value(v.y).value(v.z);
  hash.value(light.radius).value(light.cone_degrees).value(light.texture_width).value(light.texture_height);
  hash.array(std::span<const float>(light.weights)).array(std::span<const Vec3f>(light.points));
}

}  // namespace

std::string converged_key(const std::string& geometry_hash, const ViewSamplesHost& view, const Light& light,
                          int n, uint32_t seed, ReferenceOrigin origin, SphereAs sphere) {
  Hasher hash;
  hash.text("converged reference").value(version).text(geometry_hash).value(view.width).value(view.height);
  hash.array(view.triangle).array(view.position).array(view.origin).array(view.geometric_normal);
  hash_light(hash, light);
  hash.value(n).value(seed).value(static_cast<uint32_t>(origin));
  if (light.kind == LightKind::sphere && sphere == SphereAs::disc) hash.text("disc");
  return hash.hex();
}

std::filesystem::path cache_entry(const std::filesystem::path& cache_dir, const std::string& key) {
  return cache_dir / ("reference-" + key + ".bin");
}

std::optional<ReferenceScene::Converged> read_cached(const std::filesystem::path& entry, int width,
                                                     int height) {
  const std::optional<std::string> content = read_whole(entry);
  if (!content) return std::nullopt;
  if (const std::string what = defect(entry, *content, width, height); !what.empty()) {
    fmt::print(stderr, "Cached reference {} {}; it is made again.\n", entry.string(), what);
    return std::nullopt;
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  ReferenceScene::Converged converged;
  const char* at = content->data() + sizeof(Header);
  at = extract(at, pixels, converged.visibility);
  at = extract(at, pixels, converged.standard_error);
  extract(at, pixels, converged.evaluated);
  converged.from_cache = true;
  return converged;
}

std::string write_cached(const std::filesystem::path& entry, int width, int height,
                         const ReferenceScene::Converged& converged) {
  static std::atomic<unsigned> serial{0};
  std::error_code error;
  std::filesystem::create_directories(entry.parent_path(), error);
  if (error) return fmt::format("cannot make folder {}: {}", entry.parent_path().string(), error.message());

  std::string payload;
  append(payload, converged.visibility);
  append(payload, converged.standard_error);
  append(payload, converged.evaluated);
  const Header header = header_for(entry, width, height, payload);
  const std::filesystem::path part = fmt::format("{}.part-{}-{}", entry.string(), getpid(), serial++);
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(payload.data(), static_cast<std::streamsize>(payload.size()));
  file.close();
  const bool written = !file.fail();
  if (written) std::filesystem::rename(part, entry, error);
  if (written && !error) return "";
  const std::string reason = error ? error.message() : std::strerror(errno);
  std::filesystem::remove(part, error);
  return fmt::format("cannot write {}: {}", entry.string(), reason);
}

}  // namespace penumbra
