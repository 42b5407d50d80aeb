#include "report/report.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "report/files.h"
#include "report/page.h"
#include "report/pictures.h"

namespace penumbra {
namespace fs = std::filesystem;
using report::read_text;
using report::write_text;
namespace {

constexpr int known_schema_version = 1;

nlohmann::json parse_file(const fs::path& path) {
  try {
    return nlohmann::json::parse(read_text(path));
  } catch (const nlohmann::json::parse_error& e) {
    throw InputError(fmt::format("{}: not JSON: {}", path.string(), e.what()));
  }
}

// The journal of a run that has not ended. Its last line may be torn; any other bad line is an error.
nlohmann::json read_journal(const fs::path& path) {
  nlohmann::json points = nlohmann::json::array();
  std::ifstream in(path, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty()) continue;
    nlohmann::json point = nlohmann::json::parse(line, nullptr, false);
    if (!point.is_discarded())
      points.push_back(std::move(point));
    else if (in.peek() != std::ifstream::traits_type::eof())
      throw InputError(fmt::format("{}:{}: not JSON", path.string(), number));
  }
  return points;
}

nlohmann::json read_results(const fs::path& run) {
  if (!fs::is_directory(run)) throw InputError(fmt::format("{}: no such folder of results", run.string()));
  if (fs::exists(run / "results.json")) return parse_file(run / "results.json");
  if (!fs::exists(run / "run.json"))
    throw InputError(
        fmt::format("{}: holds neither results.json nor run.json; expected a folder that 'penumbra run' "
                    "has written",
                    run.string()));
  nlohmann::json header = parse_file(run / "run.json");
  const nlohmann::json version =
      header.is_object() ? header.value("schema_version", nlohmann::json()) : nlohmann::json();
  return {{"schema_version", version},
          {"run", std::move(header)},
          {"points", read_journal(run / "points.jsonl")}};
}

void check_point(const nlohmann::json& point, std::size_t index, const fs::path& run) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: /points/{}{}", (run / "results.json").string(), index, what));
  };
  if (!point.is_object()) fail(fmt::format(": found {}, expected an object", point.type_name()));
  for (const char* key : {"technique", "scene", "status"})
    if (!point.contains(key) || !point[key].is_string())
      fail(fmt::format("/{}: missing, or not a string", key));
  if (!point.contains("params") || !point["params"].is_object()) fail("/params: missing, or not an object");
}

void check_results(const nlohmann::json& results, const fs::path& run) {
  const std::string file = (run / "results.json").string();
  if (!results.is_object())
    throw InputError(fmt::format("{}: found {}, expected an object", file, results.type_name()));
  const auto version = results.find("schema_version");
  if (version == results.end() || *version != known_schema_version)
    throw InputError(fmt::format("{}: /schema_version: found {}, expected {}", file,
                                 version == results.end() ? "none" : version->dump(), known_schema_version));
  const auto points = results.find("points");
  if (points == results.end() || !points->is_array())
    throw InputError(fmt::format("{}: /points: missing, or not an array", file));
  for (std::size_t i = 0; i < points->size(); ++i) check_point((*points)[i], i, run);
}

std::string run_name(const nlohmann::json& run, const fs::path& folder) {
  for (const char* at : {"/config/name", "/name"}) {
    const nlohmann::json::json_pointer pointer(at);
    if (run.is_object() && run.contains(pointer) && run[pointer].is_string())
      return run[pointer].get<std::string>();
  }
  return fs::absolute(folder).lexically_normal().filename().string();
}

}  // namespace

ReportSummary write_report(const fs::path& run, const fs::path& out_or_empty) {
  const fs::path out = out_or_empty.empty() ? run / "report" : out_or_empty;
  nlohmann::json results = read_results(run);
  check_results(results, run);
  report::make_folder(out);

  ReportSummary summary;
  summary.index = out / "index.html";
  summary.points = results["points"].size();
  nlohmann::json pictures;
  try {
    pictures = write_pictures(run, out, results["points"], summary.pictures, summary.warnings);
  } catch (const fs::filesystem_error& e) {
    throw WriteError(e.what());
  }
  const nlohmann::json header = results.value("run", nlohmann::json::object());
  const std::string name = run_name(header, run);
  write_text(out / "assets" / "data.js", data_script({{"name", name},
                                                      {"run", header},
                                                      {"points", std::move(results["points"])},
                                                      {"pictures", std::move(pictures)},
                                                      {"warnings", summary.warnings}}));
  write_text(out / "assets" / "report.js", report_script());
  write_text(out / "assets" / "report.css", report_style());
  write_text(summary.index, index_html(name));
  return summary;
}

}  // namespace penumbra
