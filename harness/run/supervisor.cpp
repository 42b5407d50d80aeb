#include "run/supervisor.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "image/atomic_file.h"
#include "run/files.h"
#include "run/journal.h"
#include "run/progress.h"
#include "run/record.h"
#include "run/results.h"
#include "run/run_file.h"
#include "run/schedule.h"
#include "run/view.h"
#include "run/worker_process.h"

namespace penumbra::run {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

// Ctrl-C ends the sweep after what is being written, not in the middle of it.
class StopSignals {
 public:
  StopSignals() {
    stop_asked = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { stop_asked = 1; };
    ::sigaction(SIGINT, &action, &old_[0]);
    ::sigaction(SIGTERM, &action, &old_[1]);
  }
  ~StopSignals() {
    ::sigaction(SIGINT, &old_[0], nullptr);
    ::sigaction(SIGTERM, &old_[1], nullptr);
  }

 private:
  struct sigaction old_[2];
};

class Supervisor {
 public:
  Supervisor(const Plan& plan, const RunOptions& options, const Registry& registry)
      : plan_(plan),
        options_(options),
        journal_(options.out, options.resume ? Journal::Mode::resume : Journal::Mode::fresh),
        run_file_(options.out / "run.json", plan, options),
        costs_(plan.measure, registry),
        finished_(plan.points.size(), false),
        progress_(plan.points, costs_, !options.quiet) {
    for (std::size_t i = 0; i < plan.points.size(); ++i) index_[plan.points[i].id] = i;
    for (const std::string& remark : journal_.remarks()) say(remark);
  }

  RunOutcome run() {
    std::exception_ptr problem;
    try {
      for (const BatchIndices& batch : batches(plan_.points)) {
        if (stop_asked) break;
        run_batch(batch);
      }
    } catch (const WriteError&) {
      problem = std::current_exception();
      cannot_write_ = true;
    } catch (...) {
      problem = std::current_exception();
    }
    worker_.reset();
    progress_.clear();
    if (problem && !run_file_.device_known()) std::rethrow_exception(problem);
    finish(problem != nullptr);
    if (problem) std::rethrow_exception(problem);
    return outcome_;
  }

 private:
  void say(const std::string& message) {
    progress_.clear();
    fmt::print(stderr, "penumbra: {}\n", message);
  }

  void run_batch(const BatchIndices& batch) {
    std::set<std::size_t> pending(batch.begin(), batch.end());
    for (int idle_deaths = 0; !pending.empty() && !stop_asked;) {
      start_worker_for(plan_.points[*pending.begin()].scene);
      const std::size_t before = pending.size();
      serve_batch(pending);
      if (pending.size() < before) {
        idle_deaths = 0;
      } else if (!stop_asked && ++idle_deaths == 2) {
        for (std::size_t i : std::set<std::size_t>(pending))
          store(record_without_result(plan_.points[i], "failed", idle_death_), pending);
      }
    }
  }

  void start_worker_for(const std::string& scene) {
    if (worker_ && scene_ != scene) worker_.reset();
    scene_ = scene;
    if (worker_) return;
    WorkerSettings settings = options_.worker;
    settings.run_folder = std::filesystem::absolute(options_.out);
    settings.images = plan_.images;
    settings.reference_samples = plan_.reference_samples;
    settings.frames = plan_.frames;
    settings.measure = plan_.measure;
    std::vector<std::string> environment;
    if (settings.threads > 0) environment.push_back(fmt::format("LP_NUM_THREADS={}", settings.threads));
    worker_ = std::make_unique<WorkerProcess>(options_.worker_command, environment);
    worker_->send(to_json(settings));
  }

  // Until the batch is done or the worker is; whatever has no result then stays in `pending`.
  void serve_batch(std::set<std::size_t>& pending) {
    nlohmann::json points = nlohmann::json::array(), done = nlohmann::json::object();
    for (std::size_t i : pending) {
      const Point& p = plan_.points[i];
      points.push_back(to_json(p));
      const JournalEntry* entry = options_.resume ? journal_.find(p.id) : nullptr;
      if (entry && (entry->status == "ok" || entry->status == "unsupported")) done[p.id] = entry->fingerprint;
    }
    worker_->send({{"job", "batch"}, {"points", points}, {"done", done}});
    batch_done_ = false;
    std::string killed_for;
    while (!batch_done_) {
      for (const auto& event : worker_->wait(200)) handle(event, pending);
      if (stop_asked) return worker_.reset();
      if (batch_done_) break;
      if (worker_->ended()) {
        bury_worker(pending, killed_for);
        return;
      }
      if (killed_for.empty() && !(killed_for = reason_to_kill()).empty()) worker_->kill();
      progress_.show(finished_, current_point());
    }
    if (!pending.empty()) worker_.reset();  // its device answers no more
  }

  void handle(const nlohmann::json& event, std::set<std::size_t>& pending) {
    const std::string kind = event.at("event");
    if (kind == "hello") {
      run_file_.set_device(event);
    } else if (kind == "no_device") {
      throw DeviceError(event.at("message").get<std::string>());
    } else if (kind == "cannot_write") {
      throw WriteError(event.at("message").get<std::string>());
    } else if (kind == "scene") {
      run_file_.add_scene(event);
    } else if (kind == "view") {
      run_file_.add_view(event);
    } else if (kind == "result") {
      store(event.at("record"), pending);
    } else if (kind == "skip") {
      const std::size_t i = index_.at(event.at("id"));
      ++outcome_.kept;
      finished_[i] = true;
      pending.erase(i);
    } else if (kind == "lost") {
      idle_death_ = event.at("message");
    } else if (kind == "costs") {
      run_file_.add_costs(event.at("costs"));
    } else if (kind == "batch_done") {
      batch_done_ = true;
    }
  }

  void store(const nlohmann::json& record, std::set<std::size_t>& pending) {
    const std::size_t i = index_.at(record.at("id"));
    if (pending.erase(i) == 0) return;
    journal_.append(record);
    finished_[i] = true;
    if (worker_) worker_->forget_messages();
    const std::string status = record.at("status");
    if (status == "ok")
      costs_.learn(plan_.points[i], record.at("timing").at("frame_ms").at("median").get<double>() * 1e-3);
    else if (status != "unsupported")
      say(fmt::format("{}: {}: {}", status, plan_.points[i].key(), record.value("message", "")));
  }

  std::string reason_to_kill() const {
    const Heartbeat::State at = worker_->heartbeat().read();
    if (at.over_limit_s > options_.limit_grace_s)
      return fmt::format("took longer than its limit (max_time_s is {} s for one frame or build)",
                         plan_.measure.max_time_s);
    const uint64_t limit =
        options_.memory_limit_bytes ? options_.memory_limit_bytes : machine_bytes() / 10 * 9;
    const uint64_t held = worker_->resident_bytes();
    if (held > limit)
      return fmt::format("held {:.1f} GiB of memory, its limit is {:.1f} GiB", double(held) / double(1 << 30),
                         double(limit) / double(1 << 30));
    return "";
  }

  static uint64_t machine_bytes() {
    static const uint64_t bytes =
        static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
    return bytes;
  }

  // The worker is dead: the point that it was at failed with it.
  void bury_worker(std::set<std::size_t>& pending, const std::string& killed_for) {
    const Heartbeat::State at = worker_->heartbeat().read();
    const std::string how = killed_for.empty() ? "the worker was " + worker_->how_it_ended() : killed_for;
    std::string message = fmt::format("{} in stage '{}'{}.", how, at.stage,
                                      at.pass.empty() ? "" : ", last pass reached '" + at.pass + "'");
    if (killed_for.empty() && worker_->exit_code() >= 0)
      message.replace(0, how.size(), "the worker " + worker_->how_it_ended());
    const std::string tail = worker_->last_messages();
    const auto point = index_.find(at.point);
    if (point != index_.end() && pending.count(point->second)) {
      const bool too_slow = at.over_limit_s > options_.limit_grace_s && !killed_for.empty();
      nlohmann::json record =
          record_without_result(plan_.points[point->second], too_slow ? "timeout" : "failed", message);
      record["stage"] = at.stage;
      if (!at.pass.empty()) record["last_pass"] = at.pass;
      if (!tail.empty()) record["worker_messages"] = tail;
      if (worker_->signal() != 0) record["signal"] = worker_->signal();
      store(record, pending);
    }
    idle_death_ = tail.empty() ? message : message + " Its last words: " + tail;
    worker_.reset();
  }

  std::string current_point() const {
    const Heartbeat::State at = worker_->heartbeat().read();
    const auto point = index_.find(at.point);
    if (point == index_.end()) return scene_ + " " + at.stage;
    return fmt::format("{} {} {}", plan_.points[point->second].technique, scene_, at.stage);
  }

  // Also after an error: what is finished is worth its files.
  void finish(bool after_error) {
    try {
      write_summaries();
      count();
      run_file_.finish(!stop_asked && !after_error, result_points().size());
      const RecordSource source = records(journal_, result_ids());
      write_results_json(options_.out / "results.json", run_file_.json(), source);
      AtomicFile csv(options_.out / "results.csv");
      write_csv(source, [&](const std::string& line) { csv.write(line.data(), line.size()); });
      csv.commit();
      if (!stop_asked && !after_error) std::filesystem::remove_all(options_.out / ".sequence");
    } catch (const WriteError& e) {
      if (!after_error) throw;
      if (!cannot_write_) say(e.what());  // or the same full disk would be told twice
    }
    outcome_.interrupted = stop_asked;
    outcome_.folder = options_.out;
  }

  // Those of the plan and, resumed with a filter, what the run has of the others: it stays in the results.
  std::vector<const Point*> result_points() const {
    std::vector<const Point*> points;
    for (const Point& p : plan_.points) points.push_back(&p);
    for (const Point& p : plan_.left_out)
      if (options_.resume && journal_.find(p.id)) points.push_back(&p);
    return points;
  }

  // A sequence is summed up once all of its frames are there, and again when one was run again.
  void write_summaries() {
    if (plan_.frames <= 1) return;
    std::map<std::string, std::vector<const Point*>> sequences;
    for (const Point* p : result_points()) sequences[summary_id(*p)].push_back(p);
    for (auto& [id, members] : sequences) {
      std::ranges::sort(members, {}, &Point::frame);
      std::vector<nlohmann::json> frames;
      for (const Point* p : members)
        if (const JournalEntry* entry = journal_.find(p->id))
          frames.push_back(nlohmann::json::parse(journal_.line(*entry)));
      if (frames.size() != members.size() || frames.size() < 2) continue;
      nlohmann::json summary = sequence_summary(frames);
      summary["id"] = id;
      const JournalEntry* old = journal_.find(id);
      if (!old || journal_.line(*old) != dump_line(summary)) journal_.append(summary);
    }
  }

  std::vector<std::string> result_ids() const {
    const std::vector<const Point*> points = result_points();
    std::vector<std::string> ids;
    std::set<std::string> summaries;
    for (const Point* p : points) ids.push_back(p->id);
    if (plan_.frames > 1)
      for (const Point* p : points)
        if (const std::string id = summary_id(*p); summaries.insert(id).second) ids.push_back(id);
    return ids;
  }

  void count() {
    for (const Point& p : plan_.points) {
      const JournalEntry* entry = journal_.find(p.id);
      if (!entry) continue;
      if (entry->status == "ok")
        ++outcome_.ok;
      else if (entry->status == "unsupported")
        ++outcome_.unsupported;
      else if (entry->status == "timeout")
        ++outcome_.timed_out;
      else
        ++outcome_.failed;
    }
  }

  const Plan& plan_;
  const RunOptions& options_;
  Journal journal_;
  RunFile run_file_;
  CostModel costs_;
  std::vector<bool> finished_;
  Progress progress_;
  std::map<std::string, std::size_t> index_;
  std::unique_ptr<WorkerProcess> worker_;
  std::string scene_, idle_death_;
  bool batch_done_ = false, cannot_write_ = false;
  RunOutcome outcome_;
};

}  // namespace

RunOutcome run_plan(const Plan& plan, const RunOptions& options, const Registry& registry) {
  if (plan.points.empty()) throw InputError("nothing to measure: no point is left of the config.");
  const StopSignals signals;
  return Supervisor(plan, options, registry).run();
}

}  // namespace penumbra::run
