// Joins the shards of a sweep that ran on several machines into one run.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::run {

struct MergeOutcome {
  std::size_t points = 0, failed = 0;  // failed: neither ok nor unsupported
  std::vector<std::string> machines;   // one line for each that differs from the others
};

// Writes `out` as a run of its own: points.jsonl, run.json, results.json, results.csv, images/. Each point's
// "machine" names an entry of run.json's "machines"; "merged" lists the shards with what was their own
// (start, end, load, cost). Throws InputError, naming the runs and what differs: runs of different configs or
// programs, scenes of different content, unfinished runs, one point in two runs, a shard that is missing or
// there twice; `out` holds results already. WriteError when it cannot be written.
MergeOutcome merge_runs(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& out);

}  // namespace penumbra::run
