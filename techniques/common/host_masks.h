// What techniques that run on the host know of the light's samples, and where they put what a view sample
// sees of them.
#pragma once
#include <span>
#include <vector>

#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/light.h"

namespace penumbra {

class HostMasks {
 public:
  // A mask in the making, 1 = seen: of a grid one word per row, of another set 64 samples per word.
  static constexpr std::size_t most_words = 64;
  struct Layout {
    bool grid = false, infinite = false;  // infinite: the samples are directions
    int columns = 1, rows = 1;            // of a grid, up to 64 each
  };
  // What stays between frames.
  void assign(const Light& light, const LightSamples& samples, const Layout& layout);
  // For one frame; all of it must outlive the frame.
  void bind(const ViewSamplesHost& view, std::span<float> visibility, std::span<uint32_t> mask);

  // Where the light's samples lie to a view sample's horizon, beyond any rounding; `below` also where the
  // light does not shine: a rectangle behind itself, a spot light outside its cone.
  enum class Horizon { above, across, below };
  Horizon horizon(std::size_t pixel) const;
  // The shared horizon rule, sample by sample: one with dot(Ng, L - P) <= 0 is blocked, P being the position.
  void keep_above_horizon(std::size_t pixel, uint64_t* words) const;

  // Hands out the visibility and the mask of a pixel.
  void write(std::size_t pixel, const uint64_t* seen) const;
  void write_whole(std::size_t pixel, bool blocked) const;

  bool grid() const { return layout_.grid; }
  std::size_t samples() const { return samples_; }
  std::size_t words() const { return all_.size(); }
  std::size_t columns() const { return columns_; }           // samples to a word
  const std::vector<uint64_t>& all() const { return all_; }  // words with all samples in them
  std::size_t sample_at(std::size_t word, int bit) const {
    return word * columns_ + static_cast<std::size_t>(bit);
  }
  Vec3f sample(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
  const ViewSamplesHost& view() const { return view_; }
  uint64_t bytes() const;

 private:
  bool shines_on(Vec3f position) const;
  float rounding_at(Vec3f p) const;
  std::size_t write_packed(const uint64_t* seen, uint32_t* mask) const;
  std::size_t write_unpacked(const uint64_t* seen, uint32_t* mask) const;

  Light light_;
  Layout layout_;
  std::vector<float> x_, y_, z_, weights_;
  Box bounds_;
  float cone_cosine_ = -1;
  bool uniform_ = true, packed_ = false;
  std::size_t columns_ = 1, mask_words_ = 1, samples_ = 1;
  std::vector<uint64_t> all_;
  ViewSamplesHost view_;
  std::span<float> visibility_;
  std::span<uint32_t> mask_;
};

}  // namespace penumbra
