// Pages in a real browser, opened from disk: headless Chromium drives them with a script and hands back the
// document.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

namespace penumbra::test {

// What `script` (a path from the source root) has found on the page of the folder `report`: { "errors":
// [...], "checks":
// [{ "name", "ok", "found" }] }. The browser keeps its own files in `profile`.
nlohmann::json selftest(const std::filesystem::path& report, const std::filesystem::path& profile,
                        const std::filesystem::path& script);
// Every check was passed, there were some, and nothing was thrown.
void expect_all(const nlohmann::json& outcome);

}  // namespace penumbra::test
