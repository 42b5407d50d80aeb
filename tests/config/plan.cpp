// Plans from files: --set, --filter, the expanded config, and commands that run one point alone.
#include "config/plan.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fixture.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// A folder with a config and a scene of one generated mesh, removed at the end.
class PlanFile : public testing::Test {
 protected:
  PlanFile() {
    fs::create_directories(folder_);
    write("tiny.json", R"({"name": "tiny", "meshes": {"ground": {"generator": "plane"}},
      "instances": [{"mesh": "ground"}],
      "lights": [{"name": "key", "kind": "sphere", "center": [0, 3, 0], "radius": 1}],
      "cameras": [{"name": "front", "eye": [0, 2, 5], "target": [0, 0, 0]}]})");
    write("sweep.json", R"({"scene": "tiny", "mask_size": [2, 4], "light_samples": 7, "light_size": [0, 1.5],
      "techniques": [{"technique": "gears", "params": {"assignment": ["triangles", "clusters"]}}, "shadow_map"]})");
  }
  ~PlanFile() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Plan load(const std::string& name, const PlanOptions& options = {}) const {
    return load_plan(folder_ / name, options, test::registry(), {folder_});
  }
  std::string error(const std::string& name, const PlanOptions& options = {}) const {
    try {
      (void)load(name, options);
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  }

  fs::path folder_ = fs::temp_directory_path() / ("penumbra_plan_" + std::to_string(getpid()));
};

TEST_F(PlanFile, IsNamedAfterItsFileUnlessItSaysSo) {
  EXPECT_EQ(load("sweep.json").name, "sweep");
  EXPECT_EQ(load("sweep.json", {{"/name=other"}, ""}).name, "other");
}

TEST_F(PlanFile, TheExpandedConfigExpandsToTheSamePoints) {
  const Plan plan = load("sweep.json", {{"/frames=2", "/seed=9"}, ""});
  write("expanded.json", plan.expanded_config);
  const Plan again = load("expanded.json");
  EXPECT_EQ(test::keys(again.points), test::keys(plan.points));
  EXPECT_EQ(again.points.back().id, plan.points.back().id);
  EXPECT_EQ(again.expanded_config, plan.expanded_config);
}

TEST_F(PlanFile, SetReplacesValues) {
  const Plan plan = load("sweep.json", {{"/mask_size=[3]", "/techniques=ray_tracing", "/light_size=1"}, ""});
  ASSERT_EQ(plan.points.size(), 2u) << "mask_size 3 and light_samples 7";
  EXPECT_EQ(plan.points[0].light_samples.width, 3);
}

TEST_F(PlanFile, ErrorsInSetValuesNameTheAssignment) {
  EXPECT_EQ(error("sweep.json", {{"/mask_size=[8,\"x\"]"}, ""}),
            "--set '/mask_size=[8,\"x\"]': /mask_size/1: found \"x\", expected an integer from 1 to 256, or "
            "[width, height].");
  EXPECT_EQ(error("sweep.json", {{"/maks_size=8"}, ""}),
            "--set '/maks_size=8': /maks_size: found the key \"maks_size\", expected a key of a sweep "
            "config. Did you mean "
            "'mask_size'?");
}

TEST_F(PlanFile, EachPointsCommandSelectsThatPointAlone) {
  const Plan plan = load("sweep.json");
  ASSERT_GT(plan.points.size(), 5u);
  for (const Point& p : plan.points) {
    const std::string command = p.command();
    const std::size_t at = command.find(" --filter ");
    ASSERT_NE(at, std::string::npos) << command;
    std::string filter = command.substr(at + 10);
    if (filter.front() == '\'') filter = filter.substr(1, filter.size() - 2);
    const Plan one = load("sweep.json", {{}, filter});
    ASSERT_EQ(one.points.size(), 1u) << command;
    EXPECT_EQ(one.points[0].id, p.id);
    EXPECT_TRUE(command.starts_with("penumbra run " + (folder_ / "sweep.json").string())) << command;
  }
}

TEST_F(PlanFile, MissingFilesAreNamed) {
  EXPECT_EQ(error("none.json"), (folder_ / "none.json").string() + ": no such file.");
  EXPECT_NE(error("sweep.json", {{"/scene=tinny"}, ""}).find("Did you mean 'tiny'?"), std::string::npos);
  EXPECT_NE(error("sweep.json", {{"/scene=./tinny.json"}, ""}).find("no such scene file"), std::string::npos);
}

TEST_F(PlanFile, AMissingMeshIsRefusedBeforeAnythingRuns) {
  write("far.json",
        R"({"name": "far", "meshes": {"m": {"file": "no_such_mesh.ply"}},
    "instances": [{"mesh": "m"}], "lights": [{"name": "key", "kind": "point", "center": [0, 3, 0]}],
    "cameras": [{"name": "front", "eye": [0, 2, 5], "target": [0, 0, 0]}]})");
  const std::string message = error("sweep.json", {{"/scene=far"}, ""});
  EXPECT_NE(message.find("far.json:1:"), std::string::npos) << message;
  EXPECT_NE(message.find("'no_such_mesh.ply' is not found"), std::string::npos) << message;
}

TEST_F(PlanFile, WrongGeneratorParametersAreRefusedBeforeAnythingRuns) {
  write("bad.json", R"({"name": "bad", "meshes": {"g": {"generator": "plane", "params": {"sizex": 3}}},
    "instances": [{"mesh": "g"}], "lights": [{"name": "key", "kind": "point", "center": [0, 3, 0]}],
    "cameras": [{"name": "front", "eye": [0, 2, 5], "target": [0, 0, 0]}]})");
  const std::string message = error("sweep.json", {{"/scene=bad"}, ""});
  EXPECT_NE(message.find("Did you mean 'size_x'?"), std::string::npos) << message;
}

}  // namespace
}  // namespace penumbra
