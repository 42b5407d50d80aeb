// Result files: whole or absent, and errors that say which file and why.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra::run {

// Creates the folder and its parents. Throws WriteError.
void make_folder(const std::filesystem::path& folder);
// A reader sees the old file or the new one, never half of it. Throws WriteError.
void write_text(const std::filesystem::path& path, std::string_view text);
// The whole file; throws InputError when it cannot be read.
std::string read_text(const std::filesystem::path& path);

}  // namespace penumbra::run
