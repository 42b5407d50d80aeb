#include "run/scene_check.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "core/error.h"
#include "core/hash.h"
#include "run/files.h"
#include "run/provenance.h"
#include "run/record.h"
#include "scene/declaration.h"
#include "scene/mesh_search.h"
#include "scene/scene.h"
#include "scene/scene_file.h"

namespace penumbra::run {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::vector<std::string> remarks_on(const Scene& scene) {
  std::vector<std::string> remarks;
  for (const auto& mesh : scene.report().meshes) {
    const MeshHygiene& h = mesh.hygiene;
    if (h.dropped_not_finite + h.dropped_index > 0)
      remarks.push_back(fmt::format(
          "scene '{}': of the mesh '{}' ({}), {} of {} triangles are left out: {} with a corner that is not "
          "finite, {} with an index out of range.",
          scene.name(), mesh.name, mesh.origin, h.dropped_not_finite + h.dropped_index, h.triangles_in,
          h.dropped_not_finite, h.dropped_index));
  }
  return remarks;
}

// {"remarks": [...]} or {"error": "..."}.
json load(const std::string& scene, const std::vector<fs::path>& search) {
  try {
    return {{"remarks", remarks_on(Scene::load(scene, search))}};
  } catch (const InputError& e) {
    return {{"error", e.what()}};
  } catch (const std::bad_alloc&) {
    return {{"error", fmt::format("scene '{}': out of host memory while it was loaded.", scene)}};
  } catch (const std::exception& e) {
    return {{"error", fmt::format("scene '{}': {}", scene, e.what())}};
  }
}

void write_all(int fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(fd, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the parent sees a torn answer
    at += static_cast<std::size_t>(n);
  }
}

std::string read_all(int fd) {
  std::string text;
  char buffer[4096];
  for (;;) {
    const ssize_t n = ::read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

json load_apart(const std::string& scene, const std::vector<fs::path>& search) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(ends[0]);
    write_all(ends[1], dump_line(load(scene, search)));
    ::_exit(0);  // no exit handlers: what they would flush or free is the parent's
  }
  const int error = errno;
  ::close(ends[1]);
  const std::string answer = pid > 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  if (pid < 0) throw std::system_error(error, std::generic_category(), "checking a scene");
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  json result = json::parse(answer, nullptr, false);
  if (result.is_object()) return result;
  const std::string how = WIFSIGNALED(status) ? fmt::format("killed by signal {} ({})", WTERMSIG(status),
                                                            ::strsignal(WTERMSIG(status)))
                                              : fmt::format("ended with exit code {}", WEXITSTATUS(status));
  return {{"error", fmt::format("scene '{}': its reader was {}; a mesh file is damaged.", scene, how)}};
}

// Of everything that the answer depends on; a mesh file by its place, size and time, for reading it is the
// cost.
std::string hash_of(const std::string& scene, const std::vector<fs::path>& search) {
  const fs::path path = find_scene_file(scene, search);
  Hasher hasher;
  hasher.text("scene check 1")
      .text(program_version())
      .text(fs::absolute(path).string())
      .text(read_text(path));
  const std::vector<fs::path> folders = mesh_folders(path);
  for (const MeshSource& source : parse_scene_file(JsonDocument::read(path)).meshes) {
    if (source.file.empty()) continue;
    const fs::path mesh = find_mesh(source.file, folders);
    hasher.text(mesh.string())
        .value(fs::file_size(mesh))
        .value(static_cast<int64_t>(fs::last_write_time(mesh).time_since_epoch().count()));
  }
  return hasher.hex();
}

json checked(const std::string& scene, const std::vector<fs::path>& search, const fs::path& cache) {
  if (cache.empty()) return load_apart(scene, search);
  const fs::path entry = cache / "scenes" / (hash_of(scene, search) + ".json");
  std::error_code error;
  if (fs::exists(entry, error))
    if (json known = json::parse(read_text(entry), nullptr, false); known.contains("remarks")) return known;
  json result = load_apart(scene, search);
  if (result.contains("error")) return result;
  try {
    make_folder(entry.parent_path());
    write_text(entry, dump_line(result));
  } catch (const WriteError&) {
    // Then it is checked again the next time.
  }
  return result;
}

}  // namespace

std::vector<std::string> check_scenes(const std::vector<Point>& points, const std::vector<fs::path>& search,
                                      const fs::path& cache) {
  std::set<std::string> known;
  std::vector<std::string> remarks;
  std::string errors;
  for (const Point& point : points) {
    if (!known.insert(point.scene).second) continue;
    const json result = checked(point.scene, search, cache);
    if (result.contains("error")) {
      errors += (errors.empty() ? "" : "\n") + result.at("error").get<std::string>();
      continue;
    }
    for (const json& remark : result.at("remarks")) remarks.push_back(remark);
  }
  if (!errors.empty()) throw InputError(errors);
  return remarks;
}

}  // namespace penumbra::run
