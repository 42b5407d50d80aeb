// The files that a finished run leaves: results.json and results.csv, made from the journal.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "config/plan.h"
#include "run/journal.h"

namespace penumbra::run {

// Every record that counts, one at a time: a sweep's records need not fit into memory together.
using RecordSource = std::function<void(const std::function<void(const nlohmann::json&)>&)>;

// Records of the journal in the order of `ids`; ids without a record are left out.
RecordSource records(const Journal& journal, std::vector<std::string> ids);

void write_results_json(const std::filesystem::path& path, const nlohmann::json& run,
                        const RecordSource& source);
void write_csv(const RecordSource& source, const std::function<void(const std::string&)>& write);

// The record with "frame": null that sums up a sequence's frames (in order, all of one sequence).
nlohmann::json sequence_summary(const std::vector<nlohmann::json>& frames);
// Its id, which is the same whatever the frames gave.
std::string summary_id(const Point& any_frame);

// Google Benchmark's JSON format: what its compare tool reads.
nlohmann::json google_benchmark_json(const nlohmann::json& run, const RecordSource& source);

}  // namespace penumbra::run
