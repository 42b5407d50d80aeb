// A folder of results as `penumbra run` leaves it, made without running anything: spheres over a plane under
// a square light, whose visibility is computed here by sampling. For tests of what reads results.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::test {

// Names that would become markup, or end a script, if they were written as they are.
inline const std::string hostile_scene = "<b onmouseover=alert(1)>&\"knot'</script>";

struct SyntheticRun {
  int width = 160, height = 120;
  bool pictures = true;
};
// Three techniques over two scenes, one of them `hostile_scene`, with failed and unsupported points.
// Returns the content of results.json, which is written too.
nlohmann::json write_synthetic_run(const std::filesystem::path& folder, const SyntheticRun& options = {});

// A sequence of `frames` frames of two variants, the first of them with diagnostic pictures.
nlohmann::json write_moving_run(const std::filesystem::path& folder, int frames);

// `count` points without pictures.
nlohmann::json write_large_run(const std::filesystem::path& folder, int count);

}  // namespace penumbra::test
