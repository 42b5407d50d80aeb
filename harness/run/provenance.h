// Where and with what a run was made: what one has to know before one compares its times with another's.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace penumbra::run {

std::string program_version();  // "0.1.0 (commit 1a2b3c4, modified)"

std::string embree_version();  // "3.13.5"
std::string cpu_model();

// program, compiler, cpu, memory, os, environment knobs, load, start time. Device and clock are the worker's
// to say.
nlohmann::json provenance();

// 1, 5 and 15 minutes; empty where the system does not tell.
nlohmann::json load_average();

// "2026-03-01T12:00:00Z"
std::string utc_time();
// The local time as a part of a file name: "20260301-120000".
std::string folder_time();

}  // namespace penumbra::run
