// The files of a report's folder.
#pragma once
#include <filesystem>
#include <string>

namespace penumbra::report {

// Throws InputError when it cannot be read.
std::string read_text(const std::filesystem::path& path);
// Through a temporary and a rename, so that an interrupted report leaves no half file. Throws WriteError.
void write_text(const std::filesystem::path& path, const std::string& text);
// `out` with assets/. Throws InputError when it holds an index.html that is not a report's, WriteError
// when it cannot be made.
void make_folder(const std::filesystem::path& out);

}  // namespace penumbra::report
