#include "run/point_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/hash.h"
#include "run/host_memory.h"
#include "run/processors.h"

namespace penumbra::run {
namespace {

double sum_ms(const std::vector<gpu::PassTime>& times) {
  double ms = 0;
  for (const auto& t : times) ms += t.ms;
  return ms;
}

}  // namespace

double FrameTimes::build_ms() const { return sum_ms(build); }
double FrameTimes::frame_ms() const { return sum_ms(build) + sum_ms(render); }

PointRun::PointRun(const Point& point, const TechniqueInfo& info, View& view, OutputBuffers& outputs,
                   gpu::PassRecorder& passes, Heartbeat& heartbeat, Costs& costs, const TimeLimits& limits)
    : point_(point),
      info_(info),
      view_(view),
      outputs_(outputs),
      passes_(passes),
      heartbeat_(heartbeat),
      costs_(costs),
      limits_(limits),
      lit_(view.lit_frame(point)) {
  dynamic_ = lit_->step.topology || lit_->step.positions || lit_->step.light ||
             info_.rebuild_each_frame(point_.params) || point_.accumulate > 1;
  case_.device = &passes.device();
  case_.frame = &lit_->current;
  case_.geometry = &view.geometry();
  case_.light_samples = &view.light_samples(*lit_, point_);
  case_.width = point_.width;
  case_.height = point_.height;
  technique_ = info_.make(point_.params);
}

PointRun::~PointRun() = default;

ReferenceOrigin PointRun::origin() const {
  const Origin declared = info_.origin(point_.params);
  const bool exact =
      declared == Origin::exact || (declared == Origin::automatic && lit_->current.geometry.closed);
  return exact ? ReferenceOrigin::exact : ReferenceOrigin::offset;
}

std::optional<std::string> PointRun::unsupported() const {
  const LightKind kind = lit_->current.light.kind;
  if (std::find(info_.lights.begin(), info_.lights.end(), kind) == info_.lights.end()) {
    std::string takes;
    for (LightKind k : info_.lights) takes += (takes.empty() ? "" : ", ") + std::string(to_string(k));
    return fmt::format("{} takes lights of kind {}; '{}' is a {} light.", info_.name, takes, point_.light,
                       to_string(kind));
  }
  const LightSamples& samples = *case_.light_samples;
  if (point_.light_samples.rotation != LightRotation::none && samples.count() > 1) {
    if (auto reason = why_not_rotated(lit_->current.light)) return reason;
    if (!info_.rotates)
      return fmt::format("{} takes one set of light samples for all pixels, not one that each pixel moves.",
                         info_.name);
  }
  if (point_.accumulate > 1)
    if (auto reason = why_not_jittered(lit_->current.light)) return reason;
  return technique_->supports(case_);
}

void PointRun::step(const char* stage) {
  heartbeat_.stage(stage);
  heartbeat_.limit(limits_.frame_s + limits_.first_call_s);
}

void PointRun::prepare(bool with_counters) {
  allocate_output();
  gpu::Device& device = passes_.device();
  const uint64_t device_before = device.allocated_bytes();
  device.reset_peak();
  const HostMemoryPeak host_peak;
  passes_.take_times();

  lit_->current.changes = Changes{};
  step("setup");
  {
    CostTimer timer(costs_, "technique");
    const double start = now_s();
    technique_->setup(case_, passes_);
    passes_.finish();
    setup_ms = (now_s() - start) * 1e3;
  }
  passes_.take_times();

  step("build");
  if (lit_->previous) {
    // Built on the frame before, so that the frame measured is a step of the animation and not a fresh start.
    view_.show(*lit_->previous);
    case_.frame = lit_->previous.get();
    build(Changes{});
    view_.show(lit_->current);
    case_.frame = &lit_->current;
  } else {
    build(Changes{});
  }

  step("first frame");
  poison_output();
  first_frame_ms = frame_of_set(0).frame_ms();
  heartbeat_.stage("read back");
  output_ = read_output();
  {
    CostTimer timer(costs_, "counters");  // a technique may render once more to count what it does
    output_.claimed = technique_->evaluated_mask();
    output_.cosines = technique_->cosines();
    if (with_counters) output_.counters = technique_->counters();
    passes_.take_times();
  }
  memory_.structure_bytes = technique_->structure_bytes();
  memory_.device_bytes = device.peak_bytes() - std::min(device.peak_bytes(), device_before);
  memory_.host_peak_bytes = host_peak.bytes();
  heartbeat_.limit(0);
}

void PointRun::build(const Changes& changes) {
  Frame& frame = case_.frame == &lit_->current ? lit_->current : *lit_->previous;
  frame.changes = changes;
  CostTimer timer(costs_, "technique");
  technique_->build(case_, passes_);
  passes_.finish();
  build_passes = passes_.take_times();
  build_ms.push_back(sum_ms(build_passes));
}

void PointRun::rebuild() {
  heartbeat_.stage("build");
  heartbeat_.limit(limits_.frame_s);
  build(Changes{});
  heartbeat_.limit(0);
}

std::vector<Illustration> PointRun::illustrations() {
  auto* illustrated = dynamic_cast<Illustrated*>(technique_.get());
  if (!illustrated) return {};
  heartbeat_.stage("diagnostics");
  heartbeat_.limit(limits_.frame_s + limits_.first_call_s);
  CostTimer timer(costs_, "images");
  std::vector<Illustration> shown = illustrated->illustrations();
  passes_.finish();
  passes_.take_times();
  heartbeat_.limit(0);
  return shown;
}

FrameTimes PointRun::frame() { return frame_of_set((set_ + 1) % point_.accumulate); }

void PointRun::take_set(int set) {
  heartbeat_.stage("accumulation");
  heartbeat_.limit(limits_.frame_s);
  frame_of_set(set);
  output_ = read_output();
  output_.claimed = technique_->evaluated_mask();
  output_.cosines = technique_->cosines();
  passes_.take_times();
  heartbeat_.limit(0);
}

FrameTimes PointRun::frame_of_set(int set) {
  set_ = set;
  case_.light_samples = &view_.light_samples(*lit_, point_, set);
  bind_output();
  FrameTimes times;
  CostTimer timer(costs_, "technique");
  const double start = now_s(), cpu_start = process_cpu_s();
  // A point that is dynamic by its parameters alone is told that every vertex moved.
  Changes step_changes = lit_->step;
  if (info_.rebuild_each_frame(point_.params) && !lit_->previous) step_changes.positions = true;
  if (point_.accumulate > 1) step_changes.light = true;
  lit_->current.changes = step_changes;
  if (dynamic_) {
    technique_->build(case_, passes_);
    times.build = passes_.take_times();
  }
  technique_->render(input_, passes_);
  passes_.finish();
  times.render = passes_.take_times();
  times.wall_ms = (now_s() - start) * 1e3;
  times.cpu_ms = (process_cpu_s() - cpu_start) * 1e3;
  return times;
}

std::size_t PointRun::pixels() const {
  return static_cast<std::size_t>(point_.width) * static_cast<std::size_t>(point_.height);
}

std::size_t PointRun::mask_words() const {
  return info_.sampled ? pixels() * static_cast<std::size_t>(case_.light_samples->mask_words()) : 0;
}

void PointRun::allocate_output() {
  if (info_.residence_with(point_.params) == Residence::host) {
    if (outputs_.host_visibility.size() < pixels()) outputs_.host_visibility.resize(pixels());
    if (outputs_.host_mask.size() < mask_words()) outputs_.host_mask.resize(mask_words());
    return;
  }
  gpu::Device& device = passes_.device();
  gpu::ensure(outputs_.visibility, device, pixels() * sizeof(float), gpu::Memory::device, "visibility");
  if (mask_words() > 0)
    gpu::ensure(outputs_.mask, device, mask_words() * sizeof(uint32_t), gpu::Memory::device,
                "visibility masks");
}

// Before every frame: a later point of larger masks may have moved the buffers.
void PointRun::bind_output() {
  input_ = {};
  input_.scene_case = &case_;
  input_.view_samples = &view_.samples();
  if (info_.residence_with(point_.params) == Residence::host) {
    input_.host.visibility = std::span(outputs_.host_visibility).first(pixels());
    input_.host.mask = std::span(outputs_.host_mask).first(mask_words());
  } else {
    input_.device.visibility = &outputs_.visibility;
    if (mask_words() > 0) input_.device.mask = &outputs_.mask;
  }
}

// NaN everywhere: a pixel that the technique forgets to write is found, not inherited from the point before.
void PointRun::poison_output() {
  bind_output();
  if (info_.residence_with(point_.params) == Residence::host) {
    std::memset(input_.host.visibility.data(), 0xff, input_.host.visibility.size_bytes());
    std::memset(input_.host.mask.data(), 0xff, input_.host.mask.size_bytes());
    return;
  }
  passes_.device_pass("poison", [&](gpu::Commands& commands) {
    commands.fill(*input_.device.visibility, 0xffffffffU);
    if (input_.device.mask) commands.fill(*input_.device.mask, 0xffffffffU);
  });
  passes_.take_times();
}

Output PointRun::read_output() {
  Output output;
  output.visibility.resize(pixels());
  output.mask.resize(mask_words());
  if (info_.residence_with(point_.params) == Residence::host) {
    std::copy(input_.host.visibility.begin(), input_.host.visibility.end(), output.visibility.begin());
    std::copy(input_.host.mask.begin(), input_.host.mask.end(), output.mask.begin());
  } else {
    gpu::download(passes_, "read_back", outputs_.visibility, output.visibility.data(),
                  pixels() * sizeof(float));
    if (mask_words() > 0)
      gpu::download(passes_, "read_back", outputs_.mask, output.mask.data(), mask_words() * sizeof(uint32_t));
    passes_.take_times();
  }
  return output;
}

std::string PointRun::output_hash(const Output& output) const {
  Hasher hasher;
  const std::size_t words = output.mask.size() / std::max<std::size_t>(output.visibility.size(), 1);
  std::vector<uint32_t> kept;
  kept.reserve(output.visibility.size() * (1 + words));
  for (std::size_t i = 0; i < output.visibility.size(); ++i) {
    if (!evaluated_.empty() && !evaluated_[i]) continue;
    kept.push_back(std::bit_cast<uint32_t>(output.visibility[i]));
    for (std::size_t w = 0; w < words; ++w) kept.push_back(output.mask[i * words + w]);
  }
  return hasher.array(std::span<const uint32_t>(kept)).hex();
}

void PointRun::seal_output(std::vector<uint8_t> evaluated) {
  evaluated_ = std::move(evaluated);
  first_hash_ = output_hash(output_);
}

void PointRun::drop_output() { output_ = {}; }

bool PointRun::repeats_first_frame() {
  if (set_ != 0) frame_of_set(0);
  return output_hash(read_output()) == first_hash_;
}

}  // namespace penumbra::run
