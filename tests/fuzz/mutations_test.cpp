// The targets, fed a fixed set of mutations of the committed files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

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

// What breaks readers: other types, extremes, text that ends early, pieces twice or elsewhere, foreign bytes.
std::string mutated(std::string text, std::mt19937& random) {
  static const std::vector<std::string> pieces = {
      "null",       "-1",      "0",    "1e999", "-0.0", "1e-320",      "18446744073709551616",
      "[]",         "{}",      "[[]]", "\"\"",  "true", "\"\\u0000\"", "\"\xff\"",
      "}",          "]",       ",",    ":",     "//",   "/*",          "\"id\"",
      "\"params\"", "[1,2,3]", "\"*\""};
  const auto place = [&] { return text.empty() ? 0 : random() % text.size(); };
  for (auto n = 1 + random() % 3; n > 0; --n) {
    const std::size_t at = place(), length = 1 + random() % 12;
    switch (random() % 6) {
      case 0:
        text.insert(at, pieces[random() % pieces.size()]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, pieces[random() % pieces.size()]);
        break;
      case 3:
        if (!text.empty()) text[at] = static_cast<char>(random() % 256);
        break;
      case 4:
        text.insert(place(), text.substr(at, length * 4));
        break;
      default:  // a whole value by another: from a colon to the next comma
        if (const std::size_t colon = text.find(':', at), comma = text.find_first_of(",}]", colon);
            comma != std::string::npos)
          text.replace(colon + 1, comma - colon - 1, pieces[random() % pieces.size()]);
    }
  }
  if (random() % 20 == 0) text.resize(place());
  return text;
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

TEST(Fuzz, ConfigsAreReadOrRefused) {
  std::vector<std::string> seeds = texts("configs/sweeps", ".json");
  for (const std::string& text : texts("tests/fuzz/corpus", ".config.json")) seeds.push_back(text);
  survives(fuzz_configs, seeds, 6000);
}

TEST(Fuzz, ScenesAreReadOrRefused) { survives(fuzz_scenes, texts("configs/scenes", ".json", 40), 6000); }

TEST(Fuzz, ThresholdsAreReadOrRefused) {
  survives(fuzz_thresholds, texts("results/baselines", ".thresholds.json"), 6000);
}

TEST(Fuzz, JournalsAreReadOrRefused) { survives(fuzz_journals, texts("tests/fuzz/corpus", ".jsonl"), 4000); }

}  // namespace
}  // namespace penumbra::test
