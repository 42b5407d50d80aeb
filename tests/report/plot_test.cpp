// scripts/plot: which files it writes, that they are equal for equal results, and what it refuses.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "scratch_folder.h"
#include "synthetic_run.h"

namespace penumbra {
namespace {
namespace fs = std::filesystem;
using test::read_file;
using test::ScratchFolder;

int plot(const ScratchFolder& scratch, const std::string& arguments) {
  const std::string log = (scratch / "log").string();
  return WEXITSTATUS(std::system(("scripts/plot " + arguments + " >'" + log + "' 2>&1").c_str()));
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = read_file(entry.path());
  return files;
}

TEST(Plot, WritesEachSceneAndAxisAsPdfAndSvgAndTheSameBytesAgain) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  ASSERT_EQ(plot(scratch, "'" + (scratch / "run").string() + "'"), 0) << read_file(scratch / "log");
  ASSERT_EQ(plot(scratch, "'" + (scratch / "run").string() + "' -o '" + (scratch / "again").string() + "'"),
            0);
  const auto files = files_of(scratch / "run" / "plots");
  for (const char* name : {"time-ball-mask_size", "error-ball-mask_size", "time-ball-map_size",
                           "time-ball-assignment", "pareto-ball"}) {
    ASSERT_TRUE(files.contains(std::string(name) + ".pdf")) << name;
    EXPECT_EQ(files.at(std::string(name) + ".pdf").substr(0, 5), "%PDF-");
    EXPECT_NE(files.at(std::string(name) + ".svg").find("<svg"), std::string::npos);
  }
  EXPECT_TRUE(files == files_of(scratch / "again")) << "two runs of scripts/plot gave different bytes";
  // The other scene has a name full of markup: its files have names without it.
  EXPECT_EQ(
      std::count_if(files.begin(), files.end(), [](const auto& f) { return f.first.starts_with("pareto-"); }),
      4);
  for (const auto& [name, content] : files)
    EXPECT_EQ(name.find_first_of("<>&\"'/ "), std::string::npos) << name;
}

TEST(Plot, ShowsSpeedUpsOverATechnique) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  const std::string run = "'" + (scratch / "run").string() + "'";
  ASSERT_EQ(plot(scratch, run + " --speed-up ray_tracing"), 0) << read_file(scratch / "log");
  const auto files = files_of(scratch / "run" / "plots");
  EXPECT_TRUE(files.contains("speed_up-ball-mask_size.svg"));
  EXPECT_TRUE(files.contains("view_sample-ball-mask_size.svg"));
  EXPECT_EQ(plot(scratch, run + " --speed-up ray_traced"), 2);
  EXPECT_NE(read_file(scratch / "log").find("expected one of"), std::string::npos);
}

TEST(Plot, RefusesWhatIsNoResults) {
  ScratchFolder scratch;
  EXPECT_EQ(plot(scratch, "'" + (scratch / "nowhere").string() + "'"), 2);
  EXPECT_NE(read_file(scratch / "log").find("no such folder"), std::string::npos);
  std::ofstream(scratch / "results.json") << "{\"schema_version\": 9, \"points\": []}";
  EXPECT_EQ(plot(scratch, "'" + scratch.path().string() + "'"), 2);
  EXPECT_NE(read_file(scratch / "log").find("/schema_version: found 9, expected 1"), std::string::npos);
  test::write_large_run(scratch.path(), 0);
  EXPECT_EQ(plot(scratch, "'" + scratch.path().string() + "'"), 2);
  EXPECT_NE(read_file(scratch / "log").find("nothing to plot"), std::string::npos);
}

TEST(Plot, SaysWhenItsFolderCannotBeWritten) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  std::ofstream(scratch / "file") << "x";
  EXPECT_EQ(plot(scratch, "'" + (scratch / "run").string() + "' -o '" + (scratch / "file").string() + "'"),
            4);
}

}  // namespace
}  // namespace penumbra
