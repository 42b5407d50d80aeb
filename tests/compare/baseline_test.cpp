#include "compare/baseline.h"

#include <gtest/gtest.h>

#include <fstream>

#include "compare/comparison.h"
#include "compare/pool.h"
#include "compare/significance.h"
#include "core/error.h"
#include "core/machine.h"
#include "tests/compare/synthetic.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
using test::message_of;
using test::point;
using test::run_of;
using test::times;

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(Baseline, HoldsAllThatAComparisonNeeds) {
  const test::TemporaryFolder folder;
  const RunResults run = run_of({point("gears", times(10), 1.0 / 3), point("ray_tracing", times(7))});
  write(folder / "b.json", baseline_text(run));
  const RunResults back = read_results(folder / "b.json");
  const Comparison c = compare(back, run, default_thresholds());
  EXPECT_EQ(c.count(Verdict::pass), 8U);
  EXPECT_FALSE(c.bad());
  EXPECT_EQ(machine_fingerprint(back.machine(back.points[0])),
            machine_fingerprint(run.machine(run.points[0])));
}

TEST(Baseline, IsNotMadeOfARunWithHoles) {
  RunResults run = run_of({point("gears", times(10))});
  run.run["complete"] = false;
  EXPECT_NE(message_of<InputError>([&] { baseline_text(run); }).find("unfinished"), std::string::npos);
  run.run["complete"] = true, run.run["shard"] = "1/2";
  EXPECT_NE(message_of<InputError>([&] { baseline_text(run); }).find("merge"), std::string::npos);
  run = run_of({test::failed(point("gears", {}), "failed", "why")});
  EXPECT_NE(message_of<InputError>([&] { baseline_text(run); }).find("why"), std::string::npos);
  run = run_of({test::failed(point("gears", {}), "unsupported", "why")});
  EXPECT_NE(message_of<InputError>([&] { baseline_text(run); }).find("measured nothing"), std::string::npos);
}

TEST(Results, TheLastRecordOfAPointCountsAndATornLineDoesNot) {
  const test::TemporaryFolder folder;
  const json p = point("gears", times(10)), again = point("gears", times(20));
  write(folder / "run.json", run_of({}).run.dump());
  write(folder / "points.jsonl", p.dump() + "\nrubbish\n" + again.dump() + "\n" + p.dump().substr(0, 40));
  const RunResults r = read_results(folder.path());
  ASSERT_EQ(r.points.size(), 1U);
  EXPECT_EQ(r.points[0]["timing"]["frame_ms"]["samples"], again["timing"]["frame_ms"]["samples"]);
}

TEST(Results, WhatIsNoneIsRefusedByItsName) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& says) {
    write(folder / "r.json", text);
    const std::string message = message_of<InputError>([&] { read_results(folder / "r.json"); });
    EXPECT_NE(message.find("r.json"), std::string::npos) << message;
    EXPECT_NE(message.find(says), std::string::npos) << message;
  };
  refused("{", "not JSON");
  refused("[]", "found no results");
  refused(R"({"schema_version": 2, "run": {}, "points": []})", "expected 1");
  refused(R"({"schema_version": 1, "run": {}, "points": [{"id": "a"}]})", "/points/0");
  EXPECT_NE(message_of<InputError>([&] { read_results(folder.path()); }).find("points.jsonl"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_results(folder / "none"); }).find("no such"),
            std::string::npos);
}

TEST(Pool, OfRunsHasARunsMedianAsSampleAndKeepsAnchorsBesideTheirTimes) {
  std::vector<RunResults> runs;
  for (const double load : {1.0, 3.0, 2.0})  // each run on a machine of another load
    runs.push_back(run_of({point("gears", times(10 * load)), point("ray_tracing", times(20 * load))}));
  const RunResults pooled = pool(runs);
  const auto samples = pooled.points[0]["timing"]["frame_ms"]["samples"].get<std::vector<double>>();
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_NEAR(samples[1], 30, 1);
  const auto anchor = pooled.points[1]["timing"]["frame_ms"]["samples"].get<std::vector<double>>();
  for (const double r : ratio_samples(samples, anchor)) EXPECT_NEAR(r, 0.5, 1e-9);
}

TEST(Pool, RefusesWhatDoesNotBelongTogether) {
  const RunResults a = run_of({point("gears", times(10))});
  RunResults other_machine = run_of({point("gears", times(10))}, "B"), other_config = a, fewer = run_of({});
  other_config.run["config"] = {{"seed", 2}};
  for (const auto& [b, says] :
       {std::pair{other_machine, "machines"}, {other_config, "configs"}, {fewer, "no point"}})
    EXPECT_NE(message_of<InputError>([&] { pool({a, b}); }).find(says), std::string::npos);
}

TEST(Pool, IsReadFromAFolderOfRuns) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    std::filesystem::create_directory(folder / name);
    write(folder / name / "run.json", run_of({}).run.dump());
    write(folder / name / "points.jsonl", point("gears", times(10)).dump() + "\n");
  }
  EXPECT_EQ(read_results(folder.path()).points.at(0)["timing"]["frame_ms"]["samples"].size(), 2U);
}

TEST(Machine, IsToldByWhatChangesTimes) {
  json run = {{"cpu", {{"model", "A"}, {"cores", 2}}},
              {"memory_bytes", 8589934592},
              {"environment", {{"PENUMBRA_CACHE", "x"}}}};
  json other = run;
  other["memory_bytes"] = 8589900000, other["environment"]["PENUMBRA_CACHE"] = "y", other["load"] = {3};
  EXPECT_EQ(machine_of(run), machine_of(other));
  other["environment"]["LP_NUM_THREADS"] = "1";
  EXPECT_NE(machine_fingerprint(machine_of(run)), machine_fingerprint(machine_of(other)));
  EXPECT_NE(machine_difference(machine_of(run), machine_of(other)).find("LP_NUM_THREADS: none against \"1\""),
            std::string::npos);
}

}  // namespace
}  // namespace penumbra::compare
