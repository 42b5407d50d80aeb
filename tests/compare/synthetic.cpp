#include "tests/compare/synthetic.h"

#include <random>

#include "compare/significance.h"

namespace penumbra::test {

using nlohmann::json;

json stat(const std::vector<double>& samples) {
  return {{"median", samples.empty() ? 0 : compare::median(samples)}, {"samples", samples}};
}

json point(const std::string& technique, const std::vector<double>& frame_ms, double rmse,
           double mask_bits_off, const std::string& scene) {
  json p = {{"technique", technique}, {"scene", scene}, {"frame", 0}, {"status", "ok"}, {"message", ""}};
  p["id"] = technique + "-" + scene;
  p["key"] = technique + "/" + scene + "/mask_size=8";
  p["params"] = {{"mask_size", 8}, {"resolution", {64, 64}}};
  p["timing"] = {{"frame_ms", stat(frame_ms)}};
  p["metrics"] = {{"rmse", rmse}, {"zones", {{"umbra", {{"mae", rmse}}}}}};
  p["metrics_matched"] = {{"mask_bit_mismatch", mask_bits_off}};
  return p;
}

json failed(json p, const std::string& status, const std::string& message) {
  p["status"] = status, p["message"] = message;
  for (const char* key : {"timing", "metrics", "metrics_matched"}) p.erase(key);
  return p;
}

compare::RunResults run_of(const std::vector<json>& points, const std::string& cpu) {
  return {"run",
          {{"schema_version", 1}, {"name", "test"}, {"complete", true}, {"cpu", {{"model", cpu}}}},
          points};
}

compare::Thresholds thresholds(const std::string& text, const compare::KnownNames& known) {
  return compare::read_thresholds(JsonDocument::parse(text, "t.json"), known);
}

std::vector<double> times(double ms, int count, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> noise(1, 0.01);
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(ms * noise(random));
  return out;
}

}  // namespace penumbra::test
