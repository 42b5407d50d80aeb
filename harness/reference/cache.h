// Converged references on disk. An entry is read only when it is whole; writing is atomic and never an error.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "reference/reference.h"

namespace penumbra {

// Everything that a converged reference depends on, as 32 hexadecimal digits. `geometry_hash`: hash of the
// triangles.
std::string converged_key(const std::string& geometry_hash, const ViewSamplesHost& view, const Light& light,
                          int n, uint32_t seed, ReferenceOrigin origin, SphereAs sphere = SphereAs::ball);

std::filesystem::path cache_entry(const std::filesystem::path& cache_dir, const std::string& key);

// Nothing when there is no entry for this size, or one that is truncated, of another version or damaged; the
// latter kinds say so on standard error.
std::optional<ReferenceScene::Converged> read_cached(const std::filesystem::path& entry, int width,
                                                     int height);

// Writes beside the entry and renames, so that readers never see half of it. Returns why it could not, or "".
std::string write_cached(const std::filesystem::path& entry, int width, int height,
                         const ReferenceScene::Converged& converged);

}  // namespace penumbra
