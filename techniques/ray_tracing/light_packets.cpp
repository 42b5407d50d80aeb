#include "techniques/ray_tracing/light_packets.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace penumbra::ray_tracing {
namespace {

struct Tile {
  uint64_t width, height;
};

Tile tile_of(int lanes) {
  switch (lanes) {
    case 16:
      return {4, 4};
    case 8:
      return {4, 2};
    case 4:
      return {2, 2};
    default:
      return {1, 1};
  }
}

// Sample i of a grid: tile by tile, and row by row inside a tile.
uint64_t grid_key(const LightSamples& samples, std::size_t i, Tile tile) {
  const uint64_t column = i % static_cast<uint64_t>(samples.width),
                 row = i / static_cast<uint64_t>(samples.width);
  const uint64_t tile_index = row / tile.height << 32 | column / tile.width << 8;
  return tile_index | (row % tile.height * tile.width + column % tile.width);
}

uint64_t interleave(uint64_t a, uint64_t b) {
  uint64_t key = 0;
  for (unsigned bit = 0; bit < 16; ++bit)
    key |= (a >> bit & 1) << (2 * bit) | (b >> bit & 1) << (2 * bit + 1);
  return key;
}

// Along the two axes in which the samples spread most.
std::vector<uint64_t> morton_keys(const LightSamples& samples) {
  Box bounds;
  for (const Vec4f& p : samples.points) bounds.extend(p.xyz());
  const Vec3f extent = bounds.hi - bounds.lo;
  std::array<int, 3> axes{0, 1, 2};
  std::ranges::stable_sort(axes, [&](int a, int b) { return extent[a] > extent[b]; });
  const auto cell = [&](const Vec4f& p, int axis) {
    return extent[axis] > 0 ? static_cast<uint64_t>((p[axis] - bounds.lo[axis]) / extent[axis] * 65535.0F)
                            : 0;
  };
  std::vector<uint64_t> keys;
  for (const Vec4f& p : samples.points) keys.push_back(interleave(cell(p, axes[0]), cell(p, axes[1])));
  return keys;
}

std::vector<std::size_t> neighbour_order(const LightSamples& samples, int lanes) {
  std::vector<std::size_t> order(samples.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (lanes == 1) return order;
  std::vector<uint64_t> keys;
  if (samples.width > 0 && samples.height > 0)
    for (const std::size_t i : order) keys.push_back(grid_key(samples, i, tile_of(lanes)));
  else
    keys = morton_keys(samples);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return keys[i]; });
  return order;
}

}  // namespace

void LightPackets::assign(const LightSamples& samples, int lanes) {
  const std::vector<std::size_t> order = neighbour_order(samples, lanes);
  lanes_ = static_cast<std::size_t>(lanes);
  const std::size_t packets = (order.size() + lanes_ - 1) / lanes_,
                    tail = order.size() - (packets - 1) * lanes_;
  full_ = (1U << lanes) - 1, last_ = (1U << tail) - 1;
  x_.clear(), y_.clear(), z_.clear(), runs_.clear(), first_run_.assign(1, 0);
  samples_.clear();
  bounds_ = samples.bounds();
  for (std::size_t slot = 0; slot < packets * lanes_; ++slot) {
    const bool used = slot < order.size();
    const std::size_t sample = order[std::min(slot, order.size() - 1)];
    const Vec4f& p = samples.points[sample];
    x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    samples_.push_back(static_cast<uint32_t>(sample));
    const std::size_t lane = slot % lanes_;
    const bool continues = lane > 0 && used && sample == order[slot - 1] + 1 && sample % 32 != 0;
    if (continues)
      runs_.back().lane_bits = runs_.back().lane_bits << 1 | 1;
    else if (used)
      runs_.push_back({static_cast<uint32_t>(sample / 32), 1, static_cast<uint8_t>(lane),
                       static_cast<uint8_t>(sample % 32)});
    if (lane + 1 == lanes_) first_run_.push_back(static_cast<uint32_t>(runs_.size()));
  }
}

void LightPackets::move(const LightSamples& samples, Vec2f drawn, std::vector<float>& xyz) const {
  const std::size_t n = slots();
  xyz.resize(3 * n);
  for (std::size_t slot = 0; slot < n; ++slot) {
    const Vec4f p = samples.at(samples_[slot], drawn);
    xyz[slot] = p.x, xyz[n + slot] = p.y, xyz[2 * n + slot] = p.z;
  }
}

uint64_t LightPackets::bytes() const {
  return (x_.capacity() + y_.capacity() + z_.capacity()) * sizeof(float) + runs_.capacity() * sizeof(Run) +
         samples_.capacity() * sizeof(uint32_t) + first_run_.capacity() * sizeof(uint32_t);
}

}  // namespace penumbra::ray_tracing
