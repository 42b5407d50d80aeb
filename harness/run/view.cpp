#include "run/view.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "run/statistics.h"

namespace penumbra::run {
namespace {

// Beyond it the oldest masks make room: a sweep of large masks must not fill the memory with references.
constexpr std::size_t matched_budget_bytes = std::size_t{1} << 30;

std::string samples_key(const LitFrame& lit, const Point& p, int set) {
  const LightSampleRequest& r = p.light_samples;
  return fmt::format("{}/{}x{}/{}/{}/{}/{}/{}", lit.key, r.width, r.height, r.count,
                     static_cast<int>(r.pattern), r.seed, static_cast<int>(r.rotation), set);
}

double total_ms(const std::vector<gpu::PassTime>& times) {
  double ms = 0;
  for (const auto& t : times) ms += t.ms;
  return ms;
}

}  // namespace

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CostTimer::CostTimer(Costs& costs, const char* entry) : costs_(costs), entry_(entry), start_(now_s()) {}
CostTimer::~CostTimer() { costs_[entry_] += now_s() - start_; }

View::View(const Scene& scene, const Point& like, gpu::PassRecorder& passes, Costs& costs)
    : scene_(scene), passes_(passes), costs_(costs), report_(std::make_unique<nlohmann::json>()) {
  first_ = lit_frame(like);
  CostTimer timer(costs, "view_samples");
  samples_ = std::make_unique<ViewSamples>(passes.device(), like.width, like.height);
  *report_ = {{"camera", like.camera},
              {"resolution", {like.width, like.height}},
              {"frame", like.frame},
              {"triangles", first_->current.geometry.triangle_count()}};
  make_samples(first_->current);
}

View::~View() = default;

// Twice: the first time compiles pipelines and touches memory, the second is what a frame costs.
void View::make_samples(Frame& frame) {
  show(frame);
  (*report_)["upload_ms"] = total_ms(passes_.take_times());
  samples_->render(frame, geometry_, passes_);
  passes_.take_times();
  samples_->render(frame, geometry_, passes_);
  const auto times = passes_.take_times();
  (*report_)["view_samples_ms"] = total_ms(times);
  nlohmann::json& by_pass = (*report_)["view_samples_passes"] = nlohmann::json::object();
  for (const auto& t : times) by_pass[t.name] = t.ms;
  std::size_t seen = 0;
  for (uint32_t t : samples_->host().triangle) seen += t != no_triangle;
  (*report_)["view_samples"] = seen;
}

std::shared_ptr<LitFrame> View::lit_frame(const Point& point) {
  const std::string key = fmt::format("{}/{}", point.light, point.light_size);
  if (auto known = frames_[key].lock()) return known;
  CostTimer timer(costs_, "scene");
  auto lit = std::make_shared<LitFrame>();
  lit->key = key;
  const auto size = static_cast<float>(point.light_size);
  if (point.frame > 0 && scene_.animated())
    lit->previous = std::make_unique<Frame>(scene_.frame(point.frame - 1, point.light, point.camera, size));
  lit->current = scene_.frame(point.frame, point.light, point.camera, size, lit->previous.get());
  if (lit->previous)
    lit->step = lit->current.changes;
  else
    lit->step = {false, false, false, false};
  frames_[key] = lit;
  return lit;
}

void View::show(Frame& frame) {
  if (shown_ == frame.index) return;
  const Changes told = frame.changes;
  frame.changes = {geometry_.triangle_count == 0, true, true, true};  // topology never changes within a scene
  geometry_.update(passes_.device(), frame, passes_);
  passes_.finish();
  frame.changes = told;
  shown_ = frame.index;
}

const std::vector<PastPixels>& View::past(LitFrame& lit) {
  if (!past_.empty()) return past_;
  CostTimer timer(costs_, "judge");
  const bool moved = lit.step.topology || lit.step.positions || lit.step.camera;
  if (!lit.previous || !moved) return past_ = same_pixels(samples_->host().pixel_count());
  show(*lit.previous);
  ViewSamples before(passes_.device(), samples_->width(), samples_->height());
  before.render(*lit.previous, geometry_, passes_);
  passes_.take_times();
  past_ = past_pixels(samples_->host(), before.host(), *lit.previous);
  show(lit.current);
  passes_.take_times();
  return past_;
}

const LightSamples& View::light_samples(const LitFrame& lit, const Point& point, int set) {
  const std::string key = samples_key(lit, point, set);
  auto it = light_samples_.find(key);
  if (it == light_samples_.end()) {
    LightSampleRequest request = point.light_samples;
    request.set = set;
    it = light_samples_.emplace(key, make_light_samples(lit.current.light, request)).first;
  }
  return it->second;
}

ReferenceScene& View::reference() {
  if (!reference_) reference_ = std::make_unique<ReferenceScene>(first_->current.geometry);
  return *reference_;
}

const MatchedReference& View::matched(const LitFrame& lit, const Point& point, ReferenceOrigin origin,
                                      int set) {
  const std::string key = fmt::format("{}/{}", samples_key(lit, point, set), static_cast<int>(origin));
  if (const auto it = matched_.find(key); it != matched_.end()) return it->second;
  CostTimer timer(costs_, "references");
  std::size_t held = 0;
  for (const auto& [name, entry] : matched_) held += entry.mask.size() * sizeof(uint32_t);
  if (held > matched_budget_bytes) matched_.clear();
  return matched_[key] =
             reference().matched(samples_->host(), lit.current.light, light_samples(lit, point, set), origin);
}

const ReferenceScene::Converged& View::converged(const LitFrame& lit, const Point& point,
                                                 ReferenceOrigin origin, int n,
                                                 const std::filesystem::path& cache, SphereAs sphere) {
  const std::string key =
      fmt::format("{}/{}/{}/{}", lit.key, n, static_cast<int>(origin), static_cast<int>(sphere));
  if (const auto it = converged_.find(key); it != converged_.end()) return it->second;
  CostTimer timer(costs_, "references");
  return converged_[key] =
             reference().converged(samples_->host(), lit.current.light, n, point.seed, origin, cache, sphere);
}

}  // namespace penumbra::run
