#include "run/merge.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "run/files.h"
#include "run/journal.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::run {
namespace {

using nlohmann::json;
using test::message_of;
using Paths = std::vector<std::filesystem::path>;

struct Shards : testing::Test {
  json header(const std::string& shard, const std::string& cpu) const {
    return {{"schema_version", 1},
            {"name", "n"},
            {"config", {{"scene", {"a", "b"}}, {"seed", 1}}},
            {"program", {{"version", "1"}}},
            {"complete", true},
            {"shard", shard},
            {"cpu", {{"model", cpu}}},
            {"cost_s", {{"wall", 2.0}}},
            {"started", "2020" + shard},
            {"scenes", {{{"name", "a"}, {"content_hash", "x"}}}}};
  }
  void write(const std::string& name, const json& run, const std::vector<json>& points) const {
    make_folder(folder / name / "images");
    write_text(folder / name / "run.json", run.dump());
    std::string lines;
    for (const json& p : points) lines += p.dump() + "\n";
    write_text(folder / name / "points.jsonl", lines);
    write_text(folder / name / "images" / (name + ".txt"), name);
  }
  json point(const std::string& id, const std::string& scene) const {
    return {{"id", id},   {"key", "t/" + scene + "/" + id}, {"technique", "t"},        {"scene", scene},
            {"frame", 0}, {"params", json::object()},       {"status", "unsupported"}, {"message", ""}};
  }
  std::string refusal() const {
    return message_of<InputError>([&] { merge_runs({folder / "one", folder / "two"}, folder / "out"); });
  }
  test::TemporaryFolder folder;
};

TEST_F(Shards, BecomeOneRunThatKeepsEachPointsMachine) {
  write("one", header("1/2", "A"), {point("p2", "b"), point("p0", "a")});
  write("two", header("2/2", "B"), {point("p1", "a")});
  const MergeOutcome o = merge_runs({folder / "two", folder / "one"}, folder / "out");
  EXPECT_EQ(o.points, 3U);
  EXPECT_EQ(o.machines.size(), 2U);
  const json r = json::parse(read_text(folder / "out" / "results.json"));
  std::vector<std::string> ids, cpus;
  for (const json& p : r["points"]) {
    ids.push_back(p["id"]);
    cpus.push_back(r["run"]["machines"][p["machine"].get<std::string>()]["cpu"]["model"]);
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"p0", "p1", "p2"}));
  EXPECT_EQ(cpus, (std::vector<std::string>{"A", "B", "A"}));
  EXPECT_FALSE(r["run"].contains("shard"));
  EXPECT_EQ(r["run"]["merged"].size(), 2U);
  EXPECT_DOUBLE_EQ(r["run"]["cost_s"]["wall"], 4.0);
  EXPECT_EQ(r["run"]["started"], "20201/2");
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "images" / "two.txt"));
  std::size_t n = 0;
  for_each_point(folder / "out", [&](const json&) { ++n; });
  EXPECT_EQ(n, 3U);
}

TEST_F(Shards, OfDifferentConfigsProgramsOrScenesAreRefused) {
  const auto refused = [&](const json& change, const std::string& says) {
    json other = header("2/2", "A");
    other.merge_patch(change);
    write("one", header("1/2", "A"), {point("p0", "a")});
    write("two", other, {point("p1", "a")});
    EXPECT_NE(refusal().find(says), std::string::npos) << refusal();
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  };
  refused({{"config", {{"seed", 2}}}}, "config/seed: 1 against 2");
  refused({{"program", {{"version", "2"}}}}, "program");
  refused({{"scenes", {{{"name", "a"}, {"content_hash", "y"}}}}}, "scene a");
  refused({{"complete", false}}, "unfinished");
  refused({{"schema_version", 2}}, "schema version");
  refused({{"shard", "1/2"}}, "there twice");
  refused({{"shard", "2/3"}}, "2/3");
}

TEST_F(Shards, ThatAreMissingOrOverlapAreRefused) {
  write("one", header("1/3", "A"), {point("p0", "a")});
  write("two", header("3/3", "A"), {point("p1", "a")});
  EXPECT_NE(refusal().find("missing: 2."), std::string::npos) << refusal();
  write("one", header("1/2", "A"), {point("p0", "a")});
  write("two", header("2/2", "A"), {point("p0", "a")});
  EXPECT_NE(refusal().find("t/a/p0"), std::string::npos) << refusal();
}

TEST_F(Shards, AreNotJoinedIntoAFolderThatHoldsARun) {
  write("one", header("1/2", "A"), {point("p0", "a")});
  write("two", header("2/2", "A"), {point("p1", "a")});
  merge_runs({folder / "one", folder / "two"}, folder / "out");
  EXPECT_NE(refusal().find("already holds results"), std::string::npos);
}

}  // namespace
}  // namespace penumbra::run
