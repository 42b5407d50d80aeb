// Which machine a run was made on, as far as its times depend on it.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra {

// The part of run.json that tells machines apart: processor, usable cores, memory, device and driver, clock,
// threads, build type, and the environment's knobs of drivers. Host names, kernels and loads are left out:
// they change without the times changing.
nlohmann::json machine_of(const nlohmann::json& run);
// 16 hexadecimal digits; times are comparable as they are where it is the same.
std::string machine_fingerprint(const nlohmann::json& machine);
// The values by which two machines differ: "cpu.model: 'A' against 'B'", joined by "; ".
std::string machine_difference(const nlohmann::json& a, const nlohmann::json& b);

}  // namespace penumbra
