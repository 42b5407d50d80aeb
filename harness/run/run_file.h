// run.json: the config as it was understood, where it ran, what the scenes were, where the time went.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

#include "run/supervisor.h"

namespace penumbra::run {

class RunFile {
 public:
  // On --resume the file of the former run is read; its scenes stay and its start is remembered.
  RunFile(std::filesystem::path path, const Plan& plan, const RunOptions& options);

  bool device_known() const { return json_.contains("vulkan"); }
  const nlohmann::json& json() const { return json_; }
  // Each writes the file. Throws WriteError.
  void set_device(const nlohmann::json& hello);
  void add_scene(const nlohmann::json& scene);
  void finish(bool complete, std::size_t points);
  // Written with the next of the above.
  void add_view(const nlohmann::json& view);
  void add_costs(const nlohmann::json& costs);

 private:
  void write() const;
  nlohmann::json* scene_entry(const std::string& name);
  std::filesystem::path path_;
  nlohmann::json json_;
  double start_;
};

}  // namespace penumbra::run
