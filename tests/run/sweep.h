// Small sweeps of the fake technique on a scene of two triangles and a box.
#pragma once
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run/supervisor.h"
#include "tests/run/fake_technique.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::test {

class Sweep {
 public:
  Sweep();
  // A point of the fake with these parameters; its id is "p0", "p1", ...
  Sweep& add(const ParamValues& given, int frame = 0, const std::string& scene = "still");
  run::RunOutcome run(bool resume = false);

  std::filesystem::path out() const { return folder_ / "out"; }
  // results.json, and its record of one id (null when there is none).
  nlohmann::json results() const;
  nlohmann::json record(const std::string& id) const;
  // How many frames of fakes with this value have begun, in all processes so far.
  int frames_begun(double value) const;

  TemporaryFolder folder_;
  Plan plan;
  run::RunOptions options;

 private:
  void write_scene(const std::string& name, const std::string& animation) const;
};

}  // namespace penumbra::test
