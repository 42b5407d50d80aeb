// All shadow segments of one view sample, by robust Embree. The horizon rule and the ray set-up here are the
// reference's own: no technique uses them.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "embree/embree.h"
#include "reference/reference.h"

namespace penumbra {

struct ReferenceViewSample {
  Vec3f position;        // P: the horizon rule uses it
  Vec3f segment_origin;  // P' (offset) or P (exact): the segments start here
  Vec3f geometric_normal;
  uint32_t own_triangle;  // left out of `exact` segments
};

class ShadowSegments {
 public:
  // `light` and `samples` must outlive it.
  ShadowSegments(RTCScene scene, const Light& light, const LightSamples& samples, ReferenceOrigin origin);

  // `points`: the light samples as this view sample's pixel takes them (LightSamples::of_pixel). Writes the
  // mask (mask_words() words, 1 = blocked, bits past the count 0). A light sample is blocked when
  // it lies on or below the plane through P across Ng, when it belongs to a rectangle whose front does not
  // face P, when P is outside a spot light's cone, or when the open segment meets a triangle. Returns whether
  // any light sample is above the horizon: if none is, the view sample is not evaluated.
  bool blocked(const ReferenceViewSample& view, std::span<const Vec4f> points,
               std::span<uint32_t> mask) const;

  // Weighted fraction of the light samples whose bit is 0.
  float visibility(std::span<const uint32_t> mask) const;

 private:
  bool lights(Vec3f position, const Vec4f& light_point) const;
  uint32_t trace(const ReferenceViewSample& view, std::span<const Vec4f> points, std::size_t first,
                 uint32_t wanted) const;

  RTCScene scene_;
  const Light& light_;
  const LightSamples& samples_;
  ReferenceOrigin origin_;
  float cone_cosine_ = -1;
};

}  // namespace penumbra
