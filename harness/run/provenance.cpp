#include "run/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "embree/embree.h"
#include "run/build_info.h"

extern char** environ;

namespace penumbra::run {
namespace {

// The value after `key` and `separator` in the first line that begins with the key.
std::string field(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    std::string value = line.substr(line.find_first_not_of(" \t", at + 1));
    if (value.size() >= 2 && value.front() == '"') value = value.substr(1, value.size() - 2);
    return value;
  }
  return "";
}

std::string first_line(const char* file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

nlohmann::json cpu() {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int usable = ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
  return {{"model", cpu_model()},
          {"cores", std::thread::hardware_concurrency()},
          {"usable_cores", usable},
          // What vector code that is chosen at run time runs as.
          {"instruction_set", hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets())},
          {"governor", first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")}};
}

nlohmann::json os() {
  utsname name{};
  ::uname(&name);
  return {{"name", field("/etc/os-release", "PRETTY_NAME", '=')},
          {"kernel", fmt::format("{} {}", name.sysname, name.release)},
          {"machine", name.machine}};
}

uint64_t memory_bytes() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

// Variables that change what drivers, Embree or we do.
nlohmann::json environment() {
  nlohmann::json knobs = nlohmann::json::object();
  for (char** e = environ; *e; ++e) {
    const std::string entry = *e, name = entry.substr(0, entry.find('='));
    for (const char* prefix : {"LP_", "MESA_", "GALLIUM_", "VK_", "PENUMBRA_", "EMBREE_", "TBB_", "OMP_",
                               "NV_", "__GL_", "RADV_", "ANV_"})
      if (name.rfind(prefix, 0) == 0) knobs[name] = entry.substr(std::min(name.size() + 1, entry.size()));
  }
  return knobs;
}

}  // namespace

std::string program_version() {
  std::string version = build_info::version;
  if (*build_info::commit) version += std::string(" (commit ") + build_info::commit + ")";
  return version;
}

std::string embree_version() { return RTC_VERSION_STRING; }

std::string cpu_model() {
  static const std::string model = field("/proc/cpuinfo", "model name", ':');
  return model;
}

nlohmann::json provenance() {
  nlohmann::json j;
  j["program"] = {{"version", std::string(build_info::version)},
                  {"commit", std::string(build_info::commit)},
                  {"build_type", std::string(build_info::build_type)},
                  {"compiler", std::string(build_info::compiler)},
                  {"flags", std::string(build_info::flags)}};
  j["embree"] = embree_version();
  j["cpu"] = cpu();
  j["memory_bytes"] = memory_bytes();
  j["os"] = os();
  j["environment"] = environment();
  j["load"] = load_average();
  j["started"] = utc_time();
  return j;
}

nlohmann::json load_average() {
  double load[3];
  const int n = ::getloadavg(load, 3);
  nlohmann::json j = nlohmann::json::array();
  for (int i = 0; i < n; ++i) j.push_back(load[i]);
  return j;
}

std::string utc_time() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string folder_time() { return fmt::format("{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr))); }

}  // namespace penumbra::run
