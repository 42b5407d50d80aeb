#include "tests/fuzz/targets.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "compare/baseline.h"
#include "compare/comparison.h"
#include "compare/output.h"
#include "config/sweep.h"
#include "core/error.h"
#include "run/journal.h"
#include "scene/scene_file.h"
#include "tests/fuzz/registry.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

// One folder for the life of the process.
const fs::path& folder() {
  static const struct Folder {
    Folder() : path(fs::temp_directory_path() / ("penumbra_fuzz_" + std::to_string(::getpid()))) {
      fs::create_directories(path);
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
    fs::path path;
  } f;
  return f.path;
}

fs::path written(const std::string& name, const std::string& text) {
  const fs::path path = folder() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

template <class Read>
void reads_or_refuses(Read read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace

void fuzz_configs(const std::string& text) {
  reads_or_refuses([&] { parse_sweep(JsonDocument::parse(text, "c.json"), fuzz_registry(), "fuzz"); });
}

void fuzz_scenes(const std::string& text) {
  reads_or_refuses([&] { parse_scene_file(JsonDocument::parse(text, "s.json")); });
}

void fuzz_thresholds(const std::string& text) {
  reads_or_refuses([&] { compare::read_thresholds(JsonDocument::parse(text, "t.json"), {}); });
}

void fuzz_results(const std::string& text) {
  const fs::path file = written("results.json", text);
  reads_or_refuses([&] {
    const compare::RunResults results = compare::read_results(file);
    const compare::Comparison c = compare::compare(results, results, compare::default_thresholds());
    compare::table(c), compare::junit_xml(c),
        compare::to_json(c).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    compare::baseline_text(results);
  });
}

void fuzz_journals(const std::string& text) {
  const fs::path run = folder() / "run";
  fs::create_directories(run);
  written("run/points.jsonl", text);
  reads_or_refuses([&] { run::Journal(run, run::Journal::Mode::resume); });
  reads_or_refuses([&] { run::for_each_point(run, [](const nlohmann::json&) {}); });
}

}  // namespace penumbra::test
