#include "report/files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "report/page.h"

namespace penumbra::report {
namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& path, const std::string& text) {
  const fs::path temporary = fs::path(path) += ".new";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code e;
  if (out) fs::rename(temporary, path, e);
  if (!out || e) {
    fs::remove(temporary, e);
    throw WriteError(fmt::format("{}: cannot be written", path.string()));
  }
}

void make_folder(const fs::path& out) {
  const fs::path index = out / "index.html";
  if (fs::exists(index) && !is_report_page(read_text(index)))
    throw InputError(
        fmt::format("{}: exists and is not a report; choose another folder with -o", index.string()));
  std::error_code e;
  fs::create_directories(out / "assets", e);
  if (e) throw WriteError(fmt::format("{}: cannot be made: {}", out.string(), e.message()));
}

}  // namespace penumbra::report
