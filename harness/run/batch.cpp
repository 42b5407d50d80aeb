#include "run/batch.h"

#include <fmt/format.h>

#include <fstream>
#include <new>

#include "core/hash.h"
#include "image/atomic_file.h"
#include "run/files.h"
#include "run/fingerprint.h"
#include "run/flicker.h"
#include "run/processors.h"
#include "run/provenance.h"

namespace penumbra::run {
namespace {

nlohmann::json scene_json(const Scene& scene, const std::string& name) {
  const SceneReport report = scene.report();
  nlohmann::json meshes = nlohmann::json::array();
  for (const auto& m : report.meshes)
    meshes.push_back({{"name", m.name},
                      {"origin", m.origin},
                      {"closed", m.hygiene.closed()},
                      {"triangles_in", m.hygiene.triangles_in},
                      {"dropped_index", m.hygiene.dropped_index},
                      {"dropped_not_finite", m.hygiene.dropped_not_finite},
                      {"dropped_degenerate", m.hygiene.dropped_degenerate},
                      {"duplicate_vertices", m.hygiene.duplicate_vertices},
                      {"open_edges", m.hygiene.open_edges},
                      {"non_manifold_edges", m.hygiene.non_manifold_edges},
                      {"inconsistent_edges", m.hygiene.inconsistent_edges}});
  return {{"event", "scene"},
          {"name", name},
          {"title", report.name},
          {"description", report.description},
          {"fidelity", report.fidelity},
          {"triangles", report.triangles},
          {"animated", scene.animated()},
          {"content_hash", scene.content_hash()},
          {"meshes", meshes}};
}

nlohmann::json counters_json(const Counters& counters) {
  nlohmann::json j = nlohmann::json::object();
  for (const auto& [name, value] : counters)
    j[name] = std::visit([](const auto& v) { return nlohmann::json(v); }, value);
  return j;
}

// 0.3f as 0.3, not as 0.30000001192092896.
double short_double(float v) { return std::stod(fmt::format("{}", v)); }

std::vector<float> read_floats(const std::filesystem::path& path, std::size_t count) {
  std::vector<float> values(count);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(float)));
  if (!in) values.clear();
  return values;
}

}  // namespace

BatchRunner::BatchRunner(const Registry& registry, const WorkerSettings& settings, gpu::Device& device,
                         Heartbeat& heartbeat, Costs& costs, Send send)
    : registry_(registry),
      settings_(settings),
      device_(device),
      heartbeat_(heartbeat),
      costs_(costs),
      send_(std::move(send)),
      passes_(device),
      pictures_(settings.run_folder, settings.images) {
  passes_.on_pass = [this](std::string_view name) { heartbeat_.pass(name); };
}

bool BatchRunner::run(const std::vector<Point>& points, const nlohmann::json& done) {
  heartbeat_.stage("scene");
  healthy_ = true;
  const std::string problem = open_view(points.front());
  heartbeat_.limit(0);
  if (!problem.empty()) {
    // No point's fault: another process may do better.
    if (!device_answers()) {
      send_({{"event", "lost"}, {"message", problem}});
      return false;
    }
    for (const Point& p : points) fail(p, problem, heartbeat_.read());
    return true;
  }
  for (const Point& point : points) {
    if (done.value(point.id, "") == fingerprint(point)) {
      send_({{"event", "skip"}, {"id", point.id}});
      continue;
    }
    heartbeat_.enter_point(point.id);
    if (auto prepared = prepare(point)) group_.push_back(std::move(*prepared));
    heartbeat_.leave_point();
    if (!healthy_) return false;
    if (static_cast<int>(group_.size()) >= settings_.group_size || memory_is_short()) finish_group();
    if (!healthy_) return false;
  }
  finish_group();
  return healthy_;
}

std::string BatchRunner::open_view(const Point& like) {
  if (view_ && view_key_ == view_key(like)) return "";
  view_.reset();
  try {
    if (!scene_ || scene_name_ != like.scene) {
      scene_.reset();
      CostTimer timer(costs_, "scene");
      scene_.emplace(Scene::load(like.scene, settings_.scene_search));
      scene_name_ = like.scene;
      send_(scene_json(*scene_, like.scene));
    }
    heartbeat_.stage("view samples");
    heartbeat_.limit(settings_.measure.max_time_s + settings_.first_call_grace_s);
    view_ = std::make_unique<View>(*scene_, like, passes_, costs_);
    view_key_ = view_key(like);
    nlohmann::json event = view_->report();
    event["event"] = "view";
    event["scene"] = like.scene;
    send_(event);
    return "";
  } catch (const std::bad_alloc&) {
    return "out of host memory while the scene was loaded or its view samples made.";
  } catch (const std::exception& e) {
    return e.what();
  }
}

std::string BatchRunner::fingerprint(const Point& point) const {
  const gpu::DeviceInfo& device = device_.info();
  return run::fingerprint(point,
                          {scene_->content_hash(), program_version(), embree_version(), cpu_model(),
                           device.name, device.driver_version},
                          settings_);
}

std::optional<BatchRunner::Prepared> BatchRunner::prepare(const Point& point) {
  for (;;) {
    std::string message;
    try {
      return try_prepare(point);
    } catch (const WriteError&) {
      throw;
    } catch (const std::bad_alloc&) {
      message = "out of host memory.";
    } catch (const std::exception& e) {
      message = e.what();
    }
    const Heartbeat::State at = heartbeat_.read();
    passes_.abandon();
    healthy_ = device_answers();
    if (!healthy_ || group_.empty()) {
      fail(point, message, at);
      return std::nullopt;
    }
    // It may have failed for want of the memory that the points waiting to be timed hold: once more, alone.
    finish_group();
    heartbeat_.enter_point(point.id);
    if (!healthy_) return std::nullopt;
  }
}

std::optional<BatchRunner::Prepared> BatchRunner::try_prepare(const Point& point) {
  Prepared prepared;
  prepared.record = record_of(point);
  prepared.record["fingerprint"] = fingerprint(point);
  prepared.run = std::make_unique<PointRun>(
      point, find_technique(registry_, point.technique), *view_, outputs_, passes_, heartbeat_, costs_,
      TimeLimits{settings_.measure.max_time_s, settings_.first_call_grace_s});
  prepared.record["params"]["light_size"] = short_double(prepared.run->lit().current.light.size());
  std::optional<std::string> reason = prepared.run->unsupported();
  try {
    if (!reason) prepared.run->prepare(settings_.measure.counters);
  } catch (const UnsupportedError& e) {
    reason = e.what();
  }
  if (reason) {
    passes_.abandon();
    prepared.record["status"] = "unsupported";
    prepared.record["message"] = *reason;
    send_({{"event", "result"}, {"record", prepared.record}});
    return std::nullopt;
  }
  judge(prepared);
  return prepared;
}

void BatchRunner::judge(Prepared& prepared) {
  PointRun& run = *prepared.run;
  const Point& point = run.point();
  const ViewSamplesHost& view = view_->samples().host();
  std::vector<Illustration> illustrations;
  if (pictures_.wanted("diagnostics")) illustrations = run.illustrations();
  // Each frame of an accumulation is held against its own truth at once: none of their masks need stay.
  Accumulation frames;
  for (int set = 0; set < point.accumulate; ++set) {
    if (set > 0) run.take_set(set);
    heartbeat_.stage("reference");
    const MatchedReference& matched = view_->matched(run.lit(), point, run.origin(), set);
    CostTimer timer(costs_, "judge");
    frames.add(run.output(), matched, run.light_samples(), point.width);
    if (set == 0) run.seal_output(frames.evaluated());
  }
  const std::vector<float> matched_truth = frames.truth();
  const ReferenceScene::Converged* converged = nullptr;
  if (settings_.reference_samples > 0)
    converged = &view_->converged(run.lit(), point, run.origin(), settings_.reference_samples,
                                  settings_.reference_cache);
  heartbeat_.stage("metrics");
  Output& output = run.output();
  frames.take_mean(output);
  output.illustrations = std::move(illustrations);
  const std::vector<uint8_t>& evaluated = frames.evaluated();
  nlohmann::json& record = prepared.record;
  {
    CostTimer timer(costs_, "judge");
    record["metrics_matched"] = matched_metrics(output, matched_truth, frames.light_samples(), frames.bits(),
                                                evaluated, point.width, point.height);
    record["metrics"] = converged ? converged_metrics(output, *converged, evaluated, view, run.lit().current)
                                  : nlohmann::json();
  }
  judge_own_truth(prepared, evaluated);
  const std::span<const float> truth = converged ? converged->visibility : matched_truth;
  if (settings_.frames > 1 && converged)
    add_flicker(record["metrics"], run, signed_error(output.visibility, truth, evaluated));
  record["counters"] = counters_json(output.counters);
  record["memory"] = {{"device_bytes", run.memory().device_bytes},
                      {"host_peak_bytes", run.memory().host_peak_bytes},
                      {"structure_bytes", run.memory().structure_bytes}};
  heartbeat_.stage("images");
  const std::string truth_name = Hasher()
                                     .text(scene_->content_hash())
                                     .text(view_key_)
                                     .text(run.lit().key)
                                     .value(point.seed)
                                     .value(static_cast<int>(run.origin()))
                                     .value(settings_.reference_samples)
                                     .text(converged ? "" : point.id)
                                     .hex()
                                     .substr(0, 16);
  const bool estimated = converged && converged->mean_standard_error > 0;
  const Truth shown{truth, estimated ? converged->standard_error : std::span<const float>(), truth_name};
  CostTimer timer(costs_, "images");
  record["images"] = settings_.run_folder.empty()
                         ? nlohmann::json::object()
                         : pictures_.write(run, output, evaluated, shown, view, view_key_);
  if (!settings_.run_folder.empty() && pictures_.wanted("diagnostics"))
    record["diagnostics"] =
        pictures_.write_diagnostics(run, output, evaluated, shown, view, record["images"]);
  run.drop_output();
}

// Against the light as the technique says it takes it, where that is another one.
void BatchRunner::judge_own_truth(Prepared& prepared, std::span<const uint8_t> evaluated) {
  PointRun& run = *prepared.run;
  const Light& light = run.lit().current.light;
  if (!run.info().sphere_as_disc || light.kind != LightKind::sphere || settings_.reference_samples == 0)
    return;
  heartbeat_.stage("reference");
  const auto& own = view_->converged(run.lit(), run.point(), run.origin(), settings_.reference_samples,
                                     settings_.reference_cache, SphereAs::disc);
  heartbeat_.stage("metrics");
  CostTimer timer(costs_, "judge");
  prepared.record["metrics_own"] =
      converged_metrics(run.output(), own, evaluated, view_->samples().host(), run.lit().current);
}

// The error of each frame is kept beside the results until the sequence is finished: the next frame may be
// another process's.
void BatchRunner::add_flicker(nlohmann::json& metrics, PointRun& run, std::span<const float> error) {
  const Point& point = run.point();
  metrics["flicker"] = nullptr;
  if (settings_.run_folder.empty()) return;
  const auto folder = settings_.run_folder / ".sequence";
  make_folder(folder);
  const auto file = [&](int frame) { return folder / fmt::format("{}-{}.f32", sequence_key(point), frame); };
  AtomicFile out(file(point.frame));
  out.write(error.data(), error.size_bytes());
  out.commit();
  if (point.frame > 0)
    metrics["flicker"] =
        flicker(error, read_floats(file(point.frame - 1), error.size()), view_->past(run.lit()));
}

void BatchRunner::finish_group() {
  std::vector<PointRun*> runs;
  for (Prepared& p : group_) runs.push_back(p.run.get());
  const auto use_before = processor_use();
  std::vector<Measured> measured = measure(runs, settings_.measure, heartbeat_);
  const std::optional<double> others = others_share(use_before, processor_use());
  for (std::size_t i = 0; i < group_.size(); ++i) {
    if (!measured[i].error.empty()) {
      fail(runs[i]->point(), measured[i].error, measured[i].failed_at);
      healthy_ = healthy_ && device_answers();
      continue;
    }
    nlohmann::json& record = group_[i].record;
    record["status"] = "ok";
    record["message"] = "";
    record["timing"] = timing_json(measured[i]);
    record["load"] = load_average();
    record["other_programs"] = others ? nlohmann::json(*others) : nlohmann::json();
    send_({{"event", "result"}, {"record", record}});
  }
  group_.clear();
  send_({{"event", "costs"}, {"costs", costs_}});  // now: a crash of a later point must not lose them
  costs_.clear();
}

void BatchRunner::fail(const Point& point, const std::string& message, const Heartbeat::State& at) {
  nlohmann::json record = record_without_result(point, "failed", message);
  record["stage"] = at.stage;
  if (!at.pass.empty()) record["last_pass"] = at.pass;
  send_({{"event", "result"}, {"record", record}});
}

bool BatchRunner::memory_is_short() const {
  const uint64_t heap = device_.caps().heap_bytes;
  return heap > 0 && device_.allocated_bytes() > heap / 4;
}

bool BatchRunner::device_answers() {
  try {
    passes_.device_pass("device check", [](gpu::Commands& commands) { commands.barrier(); });
    passes_.finish();
    passes_.take_times();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace penumbra::run
