// Each reads one text as a file of its kind and must end with a value or with an InputError; any other
// exception leaves it, a crash ends the process.
#pragma once
#include <string>

namespace penumbra::test {

void fuzz_configs(const std::string& text);     // sweep configs, expanded to points
void fuzz_scenes(const std::string& text);      // scene files
void fuzz_thresholds(const std::string& text);  // thresholds of `compare`
void fuzz_results(const std::string& text);     // results.json and baselines, compared with themselves
void fuzz_journals(const std::string& text);    // points.jsonl, read and resumed

}  // namespace penumbra::test
