// Shadow segments in double precision, without Embree and without any predicate of the product: the oracle
// that says what a bit of a visibility mask ought to be, and how far a segment is from one with the other
// answer.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/light.h"
#include "scene/scene.h"

namespace penumbra::testing {

// What the oracle says of one shadow segment.
struct Tie {
  bool blocked = false;  // the answer in double precision
  // Scene units: ends moved by at most this much give a segment with the other answer. For visible segments
  // it is the distance to the nearest triangle; for blocked ones the shortest move *found* (a segment that
  // escapes is shown, so a small value is proof; a large one only says that none was found up to `search`).
  // Infinite when none was found.
  double distance = INFINITY;
  bool within(double tolerance) const { return distance <= tolerance; }
};

// The triangles, in a box tree of its own.
class BruteForce {
 public:
  explicit BruteForce(const Geometry& geometry);
  ~BruteForce();
  BruteForce(const BruteForce&) = delete;
  BruteForce& operator=(const BruteForce&) = delete;

  // Whether the open segment from `origin` to `light_point` (w = 1: a position; w = 0: a direction without
  // end) meets a triangle other than `skip`. Edges and corners belong to the triangle; a segment within a
  // triangle's plane misses it.
  bool blocked(Vec3d origin, Vec4d light_point, uint32_t skip = no_triangle) const;
  // The same by testing every triangle: checks the tree itself.
  bool blocked_by_exhaustion(Vec3d origin, Vec4d light_point, uint32_t skip = no_triangle) const;

  // `search`: moves up to this length are tried (scene units); 0 = 4e-6 of the diagonal of the scene's
  // bounds.
  Tie explain(Vec3d origin, Vec4d light_point, uint32_t skip = no_triangle, double search = 0) const;

  // 4e-6 of the diagonal of the scene's bounds: how near an edge or plane counts as a tie.
  double tie_tolerance() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The horizon rule: a light sample on or below the plane of P and Ng is blocked; a rectangle's sample whose
// front does not face P is; and so is a view sample outside a spot light's cone. It uses the position P,
// never the origin P'.
struct HorizonJudgement {
  bool blocked = false;
  double distance = INFINITY;  // scene units that a point must move for the other answer (tie as above)
};
HorizonJudgement judge_horizon(const Light& light, Vec3d position, Vec3d normal, Vec4d light_point);

// One bit of a mask, all rules together. `skip_own`: origin `exact`, with P in place of P'.
Tie explain_bit(const BruteForce& scene, const Light& light, const LightSamples& samples,
                const ViewSamplesHost& view, std::size_t pixel, int light_sample, bool skip_own = false);

// Whole masks by the oracle, in the layout of HostOutput::mask. For small pictures.
std::vector<uint32_t> brute_force_mask(const BruteForce& scene, const Light& light,
                                       const LightSamples& samples, const ViewSamplesHost& view,
                                       bool skip_own = false);

// Bits that differ between `mask` and the truth of `reference_mask`, and how many of them are no ties. Judges
// only pixels that `evaluated` holds (empty: all).
struct Differences {
  uint64_t bits = 0, differing = 0, unexplained = 0;
  double worst = 0;  // the largest distance among differing bits, as a multiple of the tolerance
};
Differences explain_differences(const BruteForce& scene, const Light& light, const LightSamples& samples,
                                const ViewSamplesHost& view, std::span<const uint32_t> mask,
                                std::span<const uint32_t> reference_mask, std::span<const uint8_t> evaluated,
                                bool skip_own = false);

}  // namespace penumbra::testing
