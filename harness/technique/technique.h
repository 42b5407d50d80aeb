// The one contract that every technique fulfils. A technique sees scenes, samples and the device - not the
// reference, not the metrics, not the clock, not the files.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/pass_recorder.h"
#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/scene.h"
#include "technique/params.h"

namespace penumbra {

// Where shadow segments begin: P' = P + eps Ng, or P itself with its own triangle left out; automatic:
// `exact` where all meshes of the scene are closed, else `offset`.
enum class Origin { offset, exact, automatic };
// Where a technique wants its output: device buffers or host arrays.
enum class Residence { host, device };

// One case to compute: what supports() judges and build() prepares.
struct Case {
  gpu::Device* device = nullptr;
  const Frame* frame = nullptr;                // geometry, light, camera, what changed since the last build()
  const GeometryOnDevice* geometry = nullptr;  // the frame's triangles on the device
  const LightSamples* light_samples = nullptr;
  int width = 0, height = 0;
};

// Visibility V per pixel, 1 = lit; pixels with no view sample, or none of whose light samples is above the
// horizon, may hold anything: the harness evaluates the others only, and writes 1 there. The mask has
// light_samples->mask_words() words per pixel, pixel-major, bit i of word i/32 = light sample i, 1 = blocked,
// bits past the count 0. All arrays are zeroed by nobody: a technique writes every pixel.
struct HostOutput {
  std::span<float> visibility;
  std::span<uint32_t> mask;  // empty for techniques that are not sampled
};
struct DeviceOutput {
  const gpu::Buffer* visibility = nullptr;  // float per pixel
  const gpu::Buffer* mask = nullptr;        // null for techniques that are not sampled
};

struct RenderInput {
  const Case* scene_case = nullptr;
  const ViewSamples* view_samples = nullptr;
  HostOutput host;      // set when Residence::host
  DeviceOutput device;  // set when Residence::device
};

// A number, or a list for distributions; names are documented in the room's README.
using Counters = std::map<std::string, std::variant<double, std::vector<double>>>;

class Technique {
 public:
  virtual ~Technique() = default;

  // Why this case cannot be done (a full sentence), or nothing. Called before build(); must not allocate.
  virtual std::optional<std::string> supports(const Case& c) const = 0;
  // Pipelines and tables that depend on parameters and the device alone, made once: reported as `setup_ms`.
  virtual void setup(const Case&, gpu::PassRecorder&) {}
  // Structures that depend on the scene. Called before the first render and whenever frame->changes says that
  // geometry or light changed; its passes are `build_ms`, and a dynamic point counts them into its frame.
  virtual void build(const Case& c, gpu::PassRecorder& passes) = 0;
  // One frame. No allocation after the first call of the same case. Every piece of work is a pass.
  virtual void render(const RenderInput& in, gpu::PassRecorder& passes) = 0;
  // Statistics of the last render; may be slow, is never timed.
  virtual Counters counters() { return {}; }
  // Bytes of the technique's own structures now (host and device).
  virtual uint64_t structure_bytes() const { return 0; }
  // Per pixel, what takes the place of the cosine max(0, dot(Ns, l)) in the shaded picture of the last
  // render, for techniques that shade as well; empty = the harness's own. Never timed: a pass of render()
  // makes it.
  virtual std::vector<float> cosines() { return {}; }
  // Per pixel, 1 where the technique claims an answer; empty = everywhere (planar shadows narrow it).
  virtual std::vector<uint8_t> evaluated_mask() { return {}; }
};

struct TechniqueInfo {
  std::string name, title;
  std::vector<std::string> sources;  // keys of techniques/references.bib, with the section: "GEARS, A.1"
  std::vector<ParamInfo> params;
  std::vector<LightKind> lights;      // kinds it can take
  std::vector<std::string> choosing;  // when to prefer it to others, in whole sentences; for `describe`
  bool sampled = false;               // uses the light samples and returns masks; else the light's centre or
                                      // shape: the axes of light samples make no copies
  bool rotates = false;               // takes light samples that each pixel moves (LightSamples::move)
  bool sphere_as_disc = false;        // takes a sphere for the disc through its centre that faces the view
                                      // sample, and is judged against that as well
  Residence residence = Residence::device;
  // Where that depends on the parameters (gears' backend).
  std::function<Residence(const ParamValues&)> residence_of;
  Residence residence_with(const ParamValues& values) const {
    return residence_of ? residence_of(values) : residence;
  }
  // Which origin it declares, given its parameters.
  std::function<Origin(const ParamValues&)> origin = [](const ParamValues&) { return Origin::offset; };
  // True when the params ask for the structures to be rebuilt every frame (ray_tracing's `dynamic`).
  std::function<bool(const ParamValues&)> rebuild_each_frame = [](const ParamValues&) { return false; };
  std::function<std::unique_ptr<Technique>(const ParamValues& resolved)> make;
};

// All techniques, in the order of the registry. Defined in techniques/registry.cpp; the app hands it on.
using Registry = std::vector<TechniqueInfo>;
// Throws InputError with the nearest name.
const TechniqueInfo& find_technique(const Registry& registry, const std::string& name);

}  // namespace penumbra
