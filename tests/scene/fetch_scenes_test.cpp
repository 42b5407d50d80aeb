// scripts/fetch_scenes without the network, and its list against what the program says about missing meshes.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <sstream>

#include "fixtures.h"
#include "scene/mesh_search.h"

namespace penumbra::test {
namespace {

struct Outcome {
  int code;
  std::string output;
};

Outcome run(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string output;
  std::array<char, 512> block{};
  while (fgets(block.data(), static_cast<int>(block.size()), pipe)) output += block.data();
  return {WEXITSTATUS(pclose(pipe)), output};
}

struct Row {
  std::string name, how, package, inner, file, sum;
};

std::vector<Row> mesh_list() {
  std::ifstream in("configs/scenes/meshes.list");
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    Row r;
    std::istringstream(line) >> r.name >> r.how >> r.package >> r.inner >> r.file >> r.sum;
    rows.push_back(r);
  }
  return rows;
}

TEST(FetchScenes, ListIsWellFormed) {
  ASSERT_FALSE(mesh_list().empty());
  for (const Row& r : mesh_list()) {
    EXPECT_EQ(r.sum.size(), 64U) << r.file;
    EXPECT_EQ(r.sum.find_first_not_of("0123456789abcdef"), std::string::npos) << r.file;
  }
}

TEST(FetchScenes, ProgramNamesTheCommandOfEveryMesh) {
  for (const Row& r : mesh_list()) {
    const std::string hint = how_to_get(r.file, {});
    if (r.file == "bunny.obj")
      EXPECT_EQ(hint, " Get it with: apt-get install glmark2-data");
    else
      EXPECT_EQ(hint, " Get it with: scripts/fetch_scenes " + r.name);
  }
}

TEST(FetchScenes, UnknownNameIsRefusedWithTheKnownOnes) {
  const Outcome o = run("scripts/fetch_scenes dragn");
  EXPECT_EQ(o.code, 1);
  EXPECT_CONTAINS(o.output, "unknown name 'dragn'");
  EXPECT_CONTAINS(o.output, "dragon");
}

TEST(FetchScenes, ListShowsEveryFileAndItsState) {
  TemporaryFolder target;
  const Outcome o = run("PENUMBRA_MESH_TARGET=" + target.path().string() + " scripts/fetch_scenes --list");
  EXPECT_EQ(o.code, 0);
  for (const Row& r : mesh_list()) EXPECT_CONTAINS(o.output, r.file);
  EXPECT_CONTAINS(o.output, "missing");
}

class FetchFromLocalPackage : public ::testing::Test {
 protected:
  // A stand-in `npm` that hands out a local archive.
  void SetUp() override {
    write_file(folder_ / "npm", "#!/bin/sh\ncp '" + (folder_ / "pack.tgz").string() + "' ./pack.tgz\n");
    std::filesystem::permissions(folder_ / "npm", std::filesystem::perms::owner_all);
    std::filesystem::create_directories(folder_ / "package");
    write_file(folder_ / "package/a.obj", "v 0 0 0\n");
    run("tar -C " + folder_.path().string() + " -czf " + (folder_ / "pack.tgz").string() + " package");
    sum_ = run("sha256sum " + (folder_ / "package/a.obj").string()).output.substr(0, 64);
  }
  Outcome fetch(const std::string& inner, const std::string& sum) const {
    write_file(folder_ / "list", "thing npm thing@1 " + inner + " a.obj " + sum + "\n");
    const std::string at = folder_.path().string();
    return run("PATH=" + at + ":$PATH PENUMBRA_MESH_LIST=" + at + "/list PENUMBRA_MESH_TARGET=" + at +
               "/out scripts/fetch_scenes thing");
  }
  bool kept() const { return std::filesystem::exists(folder_ / "out/a.obj"); }
  bool leftovers() const { return std::filesystem::exists(folder_ / "out/a.obj.part"); }
  TemporaryFolder folder_;
  std::string sum_;
};

TEST_F(FetchFromLocalPackage, FileIsKeptOnceAndNotFetchedAgain) {
  const Outcome first = fetch("package/a.obj", sum_), second = fetch("package/a.obj", sum_);
  EXPECT_EQ(first.code, 0) << first.output;
  EXPECT_TRUE(kept());
  EXPECT_EQ(second.code, 0);
  EXPECT_CONTAINS(second.output, "a.obj is here already");
}

TEST_F(FetchFromLocalPackage, WrongSumKeepsNothing) {
  const Outcome o = fetch("package/a.obj", std::string(64, '0'));
  EXPECT_EQ(o.code, 1);
  EXPECT_CONTAINS(o.output, "nothing was kept");
  EXPECT_FALSE(kept() || leftovers());
}

TEST_F(FetchFromLocalPackage, MissingMemberIsNamed) {
  const Outcome o = fetch("package/b.obj", sum_);
  EXPECT_EQ(o.code, 1);
  EXPECT_CONTAINS(o.output, "has no package/b.obj");
  EXPECT_FALSE(kept() || leftovers());
}

}  // namespace
}  // namespace penumbra::test
