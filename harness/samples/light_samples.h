// Light samples: one set per (light, size, pattern, seed, set of the jitter), the same for all techniques, so
// that masks can be compared bit by bit. With per-pixel rotation each pixel moves that set in its own way,
// and all techniques in the same way.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/light.h"

namespace penumbra {

enum class LightPattern { regular, jittered, halton };
enum class LightRotation { none, per_pixel };

struct LightSampleRequest {
  int width = 16, height = 16;  // mask_size; used when count == 0
  int count = 0;                // light_samples: any n >= 1, in place of width x height
  LightPattern pattern = LightPattern::regular;
  uint32_t seed = 1;
  LightRotation rotation = LightRotation::none;
  // Temporal jitter: the set of frame `set` of an accumulation. Set 0 is the one without jitter. Regular
  // grids are moved within their cells along a Halton sequence, other regular sets around the light along a
  // Kronecker sequence, jittered ones drawn anew; a Halton set goes on where the last one ended. With
  // per-pixel rotation the set stays, and each pixel's move is drawn anew.
  int set = 0;
};

// How a pixel moves the common set [Sintorn2008, sec. 4.2, for the turn of a symmetric light].
enum class PixelMove {
  none,
  shift,  // a regular grid on a rectangle, by up to half a cell to each side
  wrap,   // another set on a rectangle: around it, as on a torus [Cranley and Patterson 1976]
  turn    // a sphere: about the vertical axis through its centre
};

// Sample i of a w x h set is column i % w, row i / w; column s = (i % w + 0.5) / w along edge_u (regular).
// Bit i of word i / 32 of a mask belongs to sample i.
struct LightSamples {
  std::vector<Vec4f> points;   // w = 1: position; w = 0: unit direction towards a light at infinity
  std::vector<float> weights;  // sum 1; all equal but for textured lights
  int width = 0, height = 0;   // 0 x 0 when the set is not a grid in a rectangle's plane
  bool uniform_weights = true;
  Vec2f
      grid_shift;  // of a grid: columns and rows by which it stands off the cells' centres (temporal jitter)
  PixelMove move = PixelMove::none;
  uint32_t move_seed = 0;  // below 2^24: exact as a float
  // shift: a cell's sides. wrap: the rectangle's. turn: span_u is the sphere's centre.
  Vec3f span_u, span_v;
  std::vector<Vec2f> units;  // wrap: each sample's place in the rectangle, [0, 1)
  int count() const { return static_cast<int>(points.size()); }
  int mask_words() const { return (count() + 31) / 32; }
  // What a pixel (row-major) draws for its move, and sample i as it then takes it.
  Vec2f draw(std::size_t pixel) const;
  Vec4f at(std::size_t i, Vec2f drawn) const;
  // All of them: `points`, or `storage` filled with the moved ones.
  std::span<const Vec4f> of_pixel(std::size_t pixel, std::vector<Vec4f>& storage) const;
  // Of all that any pixel may take; of directions for a light at infinity.
  Box bounds() const;
};

// Point, directional and spot lights (and any light of size 0) give one sample. A `count` or a pattern other
// than regular gives no grid (width = height = 0) but a textured rectangle keeps it. A sphere is sampled over
// its volume.
LightSamples make_light_samples(const Light& light, const LightSampleRequest& request);

// Why a light's samples cannot be rotated per pixel, or jittered from frame to frame (a full sentence), or
// nothing.
std::optional<std::string> why_not_rotated(const Light& light);
std::optional<std::string> why_not_jittered(const Light& light);

// `n` low-discrepancy samples (scrambled by seed) over the light, for the converged reference.
LightSamples make_reference_samples(const Light& light, int n, uint32_t seed);

}  // namespace penumbra
