// The pools on the device, copied from the host's or made there.
#pragma once
#include <vector>

#include "gpu/pass_recorder.h"
#include "samples/view_samples.h"
#include "techniques/common/prefix_scan.h"
#include "techniques/line_space/tree.h"

namespace penumbra::line_space {

class DeviceTree {
 public:
  // Passes "upload_tree".
  void upload(const Pools& pools, gpu::PassRecorder& passes);

  // Pipelines for build().
  void setup(gpu::Device& device, uint32_t branching);
  // Passes "upload_casters", "upload_shafts", "n_tree", "line_space".
  void build(const GeometryOnDevice& geometry, const std::vector<uint32_t>& casters, const Grid& grid,
             const ShaftTable& table, int limit_mib, gpu::PassRecorder& passes);
  // For tests and counters.
  Pools download(const Grid& grid, gpu::PassRecorder& passes) const;

  // Pools are read from images as well, where that is faster (see shaders/words.glsl) and they fit.
  // Never, for tests of the other way.
  void refuse_images() { refuse_images_ = true; }
  bool has_images() const { return static_cast<bool>(line_space_image_); }
  const gpu::Image& tree_image() const { return tree_image_; }
  const gpu::Image& line_space_image() const { return line_space_image_; }
  const gpu::Buffer& tree() const { return tree_; }
  const gpu::Buffer& line_space() const { return line_space_; }
  const std::vector<uint32_t>& level_begin() const { return level_begin_; }
  uint64_t bytes() const;

 private:
  struct Level {
    gpu::Buffer nodes, occupancy, counts, first_child;
    uint32_t count = 0;
  };
  void allocate(gpu::Device& device, uint32_t branching, uint64_t nodes);
  void push_geometry(OccupyPush& push, const GeometryOnDevice& geometry, const Grid& grid) const;
  Level first_level(gpu::PassRecorder& passes, uint32_t occupancy_words) const;
  // Sums of `counts`, and their total.
  uint64_t scan(const gpu::Buffer& counts, const gpu::Buffer& sums, uint32_t count,
                gpu::PassRecorder& passes) const;
  void copy_to_images(gpu::PassRecorder& passes);
  void fill(const std::vector<Level>& levels, const ShaftTable& table, gpu::PassRecorder& passes);

  uint32_t branching_ = 0;
  gpu::ComputePipeline occupy_[2], children_[2], fill_, shafts_;
  PrefixScan scan_;
  gpu::Buffer tree_, nodes_, line_space_;
  gpu::Image tree_image_, line_space_image_;
  std::vector<uint32_t> level_begin_;
  bool refuse_images_ = false;
};

}  // namespace penumbra::line_space
