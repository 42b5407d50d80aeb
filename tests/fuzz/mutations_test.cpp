// The targets, fed a fixed set of mutations of the committed files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/mutate.h"
#include "tests/fuzz/targets.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> texts(const fs::path& folder, const std::string& extension, std::size_t most = 12) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().string().ends_with(extension)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  if (paths.size() > most) paths.resize(most);
  std::vector<std::string> out;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return out;
}

void survives(void (*target)(const std::string&), const std::vector<std::string>& seeds, int mutations) {
  ASSERT_FALSE(seeds.empty());
  for (const std::string& seed : seeds) target(seed);
  std::mt19937 random(20240607);
  for (int i = 0; i < mutations; ++i) {
    const std::string text = mutated(seeds[static_cast<std::size_t>(i) % seeds.size()], random);
    EXPECT_NO_THROW(target(text)) << "mutation " << i << ":\n" << text.substr(0, 3000);
    if (testing::Test::HasFailure()) return;
  }
}

std::vector<std::string> corpus(const std::string& name) { return texts("tests/fuzz/corpus/" + name, ""); }

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Fuzz, ConfigsAreReadOrRefused) {
  survives(fuzz_configs, joined(texts("configs/sweeps", ".json"), corpus("configs")), 6000);
}

TEST(Fuzz, ScenesAreReadOrRefused) {
  survives(fuzz_scenes, joined(texts("configs/scenes", ".json", 40), corpus("scenes")), 6000);
}

TEST(Fuzz, ThresholdsAreReadOrRefused) {
  survives(fuzz_thresholds, joined(texts("results/baselines", ".thresholds.json"), corpus("thresholds")),
           6000);
}

TEST(Fuzz, ResultsAreReadOrRefused) { survives(fuzz_results, corpus("results"), 2000); }

TEST(Fuzz, JournalsAreReadOrRefused) { survives(fuzz_journals, corpus("journals"), 4000); }

}  // namespace
}  // namespace penumbra::test
