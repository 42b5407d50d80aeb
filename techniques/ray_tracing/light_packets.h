// Light samples put into packets of neighbours, and the way back from a packet's lanes to the mask's bits.
#pragma once
#include <cstdint>
#include <vector>

#include "samples/light_samples.h"

namespace penumbra::ray_tracing {

class LightPackets {
 public:
  // Lanes of a packet are a tile of a grid of samples (4 x 4 for 16), or neighbours along a Morton curve.
  void assign(const LightSamples& samples, int lanes);

  std::size_t count() const { return first_run_.size() - 1; }
  // Coordinates of packet p's lanes start at p * lanes(). Lanes past the last sample repeat it.
  const float* x(std::size_t packet) const { return &x_[packet * lanes_]; }
  const float* y(std::size_t packet) const { return &y_[packet * lanes_]; }
  const float* z(std::size_t packet) const { return &z_[packet * lanes_]; }
  // Bit i set: lane i holds a sample.
  uint32_t used(std::size_t packet) const { return packet + 1 < count() ? full_ : last_; }
  // Sets the bits of the samples in the lanes whose bit is set.
  void scatter(std::size_t packet, uint32_t lane_set, uint32_t* mask) const {
    for (uint32_t r = first_run_[packet]; r < first_run_[packet + 1]; ++r)
      mask[runs_[r].word] |= (lane_set >> runs_[r].lane & runs_[r].lane_bits) << runs_[r].shift;
  }
  // Of all samples' coordinates, as any pixel may take them.
  const Box& bounds() const { return bounds_; }
  // All packets' coordinates as a pixel that has drawn `drawn` takes them: x, then y, then z, each in the
  // order of x(0).
  void move(const LightSamples& samples, Vec2f drawn, std::vector<float>& xyz) const;
  std::size_t slots() const { return x_.size(); }
  uint64_t bytes() const;

 private:
  // `lanes` consecutive lanes from `lane` on are bits `shift` and up of mask word `word`.
  struct Run {
    uint32_t word, lane_bits;  // lane_bits: mask of the run's lanes, moved down to bit 0
    uint8_t lane, shift;
  };
  std::size_t lanes_ = 1;
  uint32_t full_ = 0, last_ = 0;
  std::vector<float> x_, y_, z_;
  std::vector<uint32_t> samples_;  // of each slot
  Box bounds_;
  std::vector<Run> runs_;
  std::vector<uint32_t> first_run_{0};
};

}  // namespace penumbra::ray_tracing
