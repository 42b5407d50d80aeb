// The results that are compared: of a run's folder, of a results.json, or of a committed baseline.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::compare {

struct RunResults {
  std::string name;                    // the path as given
  nlohmann::json run;                  // run.json
  std::vector<nlohmann::json> points;  // only what comparisons and baselines need of each
  std::filesystem::path folder;        // that its points' images are relative to; empty: it has none
  // Machine of a point: its own in a merged run, else the run's.
  nlohmann::json machine(const nlohmann::json& point) const;
};

// A folder with points.jsonl (the last record of an id counts, torn lines do not), else its results.json; or
// a file in results.json's format; or a folder of such folders, runs of one config that are pooled. Throws
// InputError.
RunResults read_results(const std::filesystem::path& path);

// The part of a record that is kept: what identifies it, its status, its times with their samples, memory,
// metrics, scalar counters, and where its images are.
nlohmann::json essential(const nlohmann::json& record);

// What makes two points the same: technique, scene, frame and all parameters.
std::string identity(const nlohmann::json& point);

// Every figure of a point by its dotted name: "metrics.rmse", "metrics.zones.umbra.mae",
// "timing.passes.trace". Times are STAT objects, everything else is a number or null.
std::map<std::string, nlohmann::json> figures(const nlohmann::json& point);

// Scalar figure; nothing when it is absent or null.
std::optional<double> number_at(const std::map<std::string, nlohmann::json>& figures,
                                const std::string& name);

}  // namespace penumbra::compare
