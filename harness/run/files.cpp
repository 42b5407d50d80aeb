#include "run/files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "image/atomic_file.h"

namespace penumbra::run {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw WriteError(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read.", path.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace penumbra::run
