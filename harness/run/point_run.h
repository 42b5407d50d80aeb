// One point in a worker: the technique's instance, its output, and one frame of it at a time. Who times what,
// and how often, is decided in measure.h; what the output is worth, in judge.h.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/plan.h"
#include "gpu/pass_recorder.h"
#include "run/heartbeat.h"
#include "run/view.h"
#include "technique/illustration.h"
#include "technique/technique.h"

namespace penumbra::run {

// Where techniques write; shared by the points of a worker, because each is read before the next one writes.
struct OutputBuffers {
  gpu::Buffer visibility, mask;
  std::vector<float> host_visibility;
  std::vector<uint32_t> host_mask;
};

// The technique's answer, as it came.
struct Output {
  std::vector<float> visibility;
  std::vector<uint32_t> mask;    // empty for techniques that are not sampled
  std::vector<uint8_t> claimed;  // empty: everywhere
  std::vector<float> cosines;    // empty: the harness's
  Counters counters;
  std::vector<Illustration> illustrations;  // where they are asked for
};

struct FrameTimes {
  std::vector<gpu::PassTime> build, render;  // build: of a dynamic point, else empty
  double wall_ms = 0;
  double cpu_ms = 0;  // of all threads of the process: what other programs take away does not count
  double build_ms() const;
  double frame_ms() const;  // all passes, those of a dynamic point's build too
};

struct PointMemory {
  uint64_t device_bytes = 0, host_peak_bytes = 0, structure_bytes = 0;
};

// Past them a worker is killed by the supervisor.
struct TimeLimits {
  double frame_s = 60;       // one frame or build
  double first_call_s = 30;  // set-up, build and first frame may take so much longer: they compile pipelines
};

class PointRun {
 public:
  PointRun(const Point& point, const TechniqueInfo& info, View& view, OutputBuffers& outputs,
           gpu::PassRecorder& passes, Heartbeat& heartbeat, Costs& costs, const TimeLimits& limits);
  ~PointRun();

  const Point& point() const { return point_; }
  const TechniqueInfo& info() const { return info_; }
  const LitFrame& lit() const { return *lit_; }
  LitFrame& lit() { return *lit_; }
  // Built anew in every frame: because the parameters say so, because the scene or its light moves, or
  // because every frame has another set of light samples.
  bool dynamic() const { return dynamic_; }
  ReferenceOrigin origin() const;

  // A full sentence when the technique cannot do this case.
  std::optional<std::string> unsupported() const;
  // Set-up, build, first frame; afterwards output() and memory() say what came. Throws PointError.
  void prepare(bool with_counters = true);
  Output& output() { return output_; }
  // The frame of another set of an accumulation, after prepare(), which took set 0; output() is then its own.
  // Throws PointError.
  void take_set(int set);
  // What the technique shows of the last frame; empty for techniques that show nothing.
  std::vector<Illustration> illustrations();
  const LightSamples& light_samples() const { return *case_.light_samples; }
  const PointMemory& memory() const { return memory_; }
  // Keeps a hash of the output's evaluated pixels: of set 0, before another is taken.
  void seal_output(std::vector<uint8_t> evaluated);
  void drop_output();

  // One frame more; of an accumulation, of the next set. Throws PointError.
  FrameTimes frame();
  // One build more of a point that is not dynamic, as if the scene were new.
  void rebuild();
  // After an error of any of these: nothing that it had recorded will run.
  void abandon() { passes_.abandon(); }
  // Do the evaluated pixels hold, bit for bit, what the first frame gave? After seal_output(), right after
  // frame().
  bool repeats_first_frame();

  double setup_ms = 0;
  std::vector<double> build_ms;             // of builds outside frames
  std::vector<gpu::PassTime> build_passes;  // of the last of them
  double first_frame_ms = 0;

 private:
  void build(const Changes& changes);
  FrameTimes frame_of_set(int set);
  std::size_t pixels() const;
  std::size_t mask_words() const;  // of all pixels
  void allocate_output();
  void bind_output();
  void poison_output();
  Output read_output();
  std::string output_hash(const Output& output) const;
  void step(const char* stage);
  Point point_;
  const TechniqueInfo& info_;
  View& view_;
  OutputBuffers& outputs_;
  gpu::PassRecorder& passes_;
  Heartbeat& heartbeat_;
  Costs& costs_;
  TimeLimits limits_;
  std::shared_ptr<LitFrame> lit_;
  bool dynamic_ = false;
  int set_ = 0;  // of the last frame
  Case case_;
  RenderInput input_;
  std::unique_ptr<Technique> technique_;
  Output output_;
  std::vector<uint8_t> evaluated_;
  std::string first_hash_;
  PointMemory memory_;
};

}  // namespace penumbra::run
