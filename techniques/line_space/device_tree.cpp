#include "techniques/line_space/device_tree.h"

#include <array>

#include "shaders/line_space_children.h"
#include "shaders/line_space_fill.h"
#include "shaders/line_space_line_space.h"
#include "shaders/line_space_occupy.h"

namespace penumbra::line_space {
namespace {

constexpr auto on_device = gpu::Memory::device;

uint64_t groups_of(uint64_t invocations) { return (invocations + group_lanes - 1) / group_lanes; }

gpu::Buffer words(gpu::Device& device, uint64_t count, const char* what) {
  return gpu::Buffer(device, std::max<uint64_t>(count, 1) * sizeof(uint32_t), on_device, what);
}

constexpr uint64_t row_bytes = uint64_t{word_row} * 4 * sizeof(uint32_t);

uint64_t in_rows(uint64_t bytes) {
  return std::max<uint64_t>(1, (bytes + row_bytes - 1) / row_bytes) * row_bytes;
}

// An image of all words of a buffer of whole rows, one or four to a texel.
void copy_words(gpu::PassRecorder& passes, const gpu::Buffer& from, gpu::Image& to, const char* pass,
                uint32_t per_texel) {
  gpu::ImageDesc desc;
  desc.width = word_row * 4 / per_texel, desc.height = static_cast<uint32_t>(from.bytes() / row_bytes);
  desc.format = per_texel == 4 ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32_UINT;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (!to || to.desc().height != desc.height) to = gpu::Image(passes.device(), desc, "line space: words");
  passes.device_pass(pass, [&](gpu::Commands& commands) {
    commands.initialise(to);
    commands.barrier();
    commands.copy_buffer_to_image(from, to, VK_IMAGE_ASPECT_COLOR_BIT);
  });
}

// The shaft table with rows in whole texels, in whole rows of an image.
std::vector<uint32_t> padded_rows(const ShaftTable& table) {
  const uint32_t n = table.branching(), stride = (table.words() + 3) / 4 * 4, subnodes = n * n * n;
  std::vector<uint32_t> rows(in_rows(uint64_t{stride} * subnodes * 4) / 4, 0);
  for (uint32_t c = 0; c < subnodes; ++c)
    std::copy_n(table.row(c), table.words(), rows.data() + std::size_t{c} * stride);
  return rows;
}

}  // namespace

void DeviceTree::allocate(gpu::Device& device, uint32_t branching, uint64_t nodes) {
  const PoolBytes bytes = pool_bytes(branching, nodes);
  gpu::ensure(tree_, device, in_rows(bytes.tree), on_device, "line space: tree pool");
  gpu::ensure(nodes_, device, bytes.nodes, on_device, "line space: node pool");
  gpu::ensure(line_space_, device, in_rows(bytes.line_space), on_device, "line space: line space pool");
}

void DeviceTree::copy_to_images(gpu::PassRecorder& passes) {
  const gpu::Device& device = passes.device();
  const uint64_t most = uint64_t{device.caps().max_image_2d} * row_bytes;
  if (refuse_images_ || !device.info().software || device.caps().max_image_2d < 4 * word_row ||
      tree_.bytes() > most || line_space_.bytes() > most) {
    tree_image_ = {}, line_space_image_ = {};
    return;
  }
  copy_words(passes, tree_, tree_image_, "copy_to_images", 1);
  copy_words(passes, line_space_, line_space_image_, "copy_to_images", 1);
}

uint64_t DeviceTree::bytes() const {
  return tree_.bytes() + nodes_.bytes() + line_space_.bytes() + (tree_image_ ? tree_image_.bytes() : 0) +
         (line_space_image_ ? line_space_image_.bytes() : 0);
}

void DeviceTree::upload(const Pools& pools, gpu::PassRecorder& passes) {
  const auto subnodes = pools.tree.size() / pools.nodes.size();
  uint32_t n = 2;
  while (std::size_t{n} * n * n < subnodes) ++n;
  allocate(passes.device(), n, pools.nodes.size());
  gpu::upload(passes, "upload_tree", tree_, pools.tree.data(), pools.tree.size() * sizeof(uint32_t));
  gpu::upload(passes, "upload_tree", nodes_, pools.nodes.data(), pools.nodes.size() * sizeof(Node));
  gpu::upload(passes, "upload_tree", line_space_, pools.line_space.data(),
              pools.line_space.size() * sizeof(uint32_t));
  level_begin_ = pools.level_begin;
  copy_to_images(passes);
  passes.finish();  // the arrays that it copies from may end
}

void DeviceTree::setup(gpu::Device& device, uint32_t branching) {
  branching_ = branching;
  for (uint32_t stage = 0; stage < 2; ++stage) {
    const std::array<gpu::Specialization, 2> constants{{{0, branching}, {1, stage}}};
    occupy_[stage] = gpu::ComputePipeline(device, line_space_occupy_spv, sizeof(OccupyPush), constants);
    children_[stage] = gpu::ComputePipeline(device, line_space_children_spv, sizeof(ChildrenPush), constants);
  }
  const std::array<gpu::Specialization, 1> constants{{{0, branching}}};
  fill_ = gpu::ComputePipeline(device, line_space_fill_spv, sizeof(FillPush), constants);
  shafts_ = gpu::ComputePipeline(device, line_space_line_space_spv, sizeof(LineSpacePush), constants,
                                 std::array{gpu::ImageUse::sampled_nearest});
  scan_.setup(device, std::min(device.caps().subgroup_size, 32U));
}

uint64_t DeviceTree::scan(const gpu::Buffer& counts, const gpu::Buffer& sums, uint32_t count,
                          gpu::PassRecorder& passes) const {
  const gpu::Buffer scratch(passes.device(), scan_.scratch_bytes(count), on_device,
                            "line space: prefix sums");
  uint32_t total[2];
  passes.device_pass("n_tree",
                     [&](gpu::Commands& commands) { scan_.record(commands, counts, sums, scratch, count); });
  gpu::download(passes, "n_tree", scratch, total, sizeof total);
  passes.finish();
  return PrefixScan::total(total);
}

void DeviceTree::push_geometry(OccupyPush& push, const GeometryOnDevice& geometry, const Grid& grid) const {
  push.positions = geometry.positions.address(), push.indices = geometry.indices.address();
  push.lo = grid.lo, push.scale = grid.leaf_scale(), push.padding = grid.padding();
}

// The root.
DeviceTree::Level DeviceTree::first_level(gpu::PassRecorder& passes, uint32_t occupancy_words) const {
  Level level;
  level.count = 1;
  level.nodes = gpu::Buffer(passes.device(), sizeof(Node), on_device, "line space: nodes of a level");
  level.occupancy = words(passes.device(), occupancy_words, "line space: occupied subnodes");
  passes.device_pass("n_tree", [&](gpu::Commands& commands) { commands.fill(level.nodes, 0); });
  return level;
}

void DeviceTree::build(const GeometryOnDevice& geometry, const std::vector<uint32_t>& casters,
                       const Grid& grid, const ShaftTable& table, int limit_mib, gpu::PassRecorder& passes) {
  gpu::Device& device = passes.device();
  const uint32_t n = branching_, occupancy_words = (n * n * n + 31) / 32;
  std::vector<uint32_t> first_pairs(2 * casters.size(), 0);
  for (std::size_t i = 0; i < casters.size(); ++i) first_pairs[2 * i] = casters[i];
  auto pair_count = static_cast<uint32_t>(casters.size());
  check_memory(n, 1, pair_count, limit_mib);
  gpu::Buffer pairs = words(device, first_pairs.size(), "line space: pairs of triangle and node");
  if (pair_count)
    gpu::upload(passes, "upload_casters", pairs, first_pairs.data(), first_pairs.size() * sizeof(uint32_t));
  passes.finish();

  std::vector<Level> levels;
  levels.push_back(first_level(passes, occupancy_words));
  uint64_t nodes = 1;
  for (uint32_t l = 0, subnode = grid.fine_cells(); l < grid.depth; ++l, subnode /= n) {
    Level& level = levels.back();
    level.counts = words(device, level.count, "line space: children of nodes");
    level.first_child = words(device, level.count, "line space: first children");
    const gpu::Buffer counts = words(device, pair_count, "line space: subnodes of pairs");
    OccupyPush push{};
    push_geometry(push, geometry, grid);
    push.pairs = pairs.address(), push.nodes = level.nodes.address();
    push.occupancy = level.occupancy.address(), push.counts = counts.address();
    push.count = pair_count, push.subnode = subnode;
    ChildrenPush children{};
    children.nodes = level.nodes.address(), children.occupancy = level.occupancy.address();
    children.counts = level.counts.address(), children.first_child = level.first_child.address();
    children.count = level.count, children.subnode = subnode;
    passes.device_pass("n_tree", [&](gpu::Commands& commands) {
      commands.fill(level.occupancy, 0);
      commands.barrier();
      if (pair_count) commands.dispatch(occupy_[0], push, groups_of(pair_count));
      commands.barrier();
      commands.dispatch(children_[0], children, groups_of(level.count));
    });
    const uint64_t next_nodes = scan(level.counts, level.first_child, level.count, passes);
    if (l + 1 == grid.depth) break;

    const gpu::Buffer offsets = words(device, pair_count, "line space: places of pairs");
    const uint64_t next_pairs = pair_count ? scan(counts, offsets, pair_count, passes) : 0;
    check_memory(n, nodes + next_nodes, pair_count + next_pairs, limit_mib);
    nodes += next_nodes;
    Level next;
    next.count = static_cast<uint32_t>(next_nodes);
    next.nodes = gpu::Buffer(device, std::max<uint64_t>(next_nodes, 1) * sizeof(Node), on_device,
                             "line space: nodes of a level");
    next.occupancy = words(device, next_nodes * occupancy_words, "line space: occupied subnodes");
    gpu::Buffer below = words(device, 2 * next_pairs, "line space: pairs of triangle and node");
    push.counts = offsets.address(), push.first_child = level.first_child.address();
    push.next_pairs = below.address(), children.next_nodes = next.nodes.address();
    passes.device_pass("n_tree", [&](gpu::Commands& commands) {
      if (pair_count) commands.dispatch(occupy_[1], push, groups_of(pair_count));
      commands.dispatch(children_[1], children, groups_of(level.count));
    });
    passes.finish();
    pairs = std::move(below), pair_count = static_cast<uint32_t>(next_pairs);
    levels.push_back(std::move(next));
    if (!next_nodes) break;
  }
  allocate(device, n, nodes);
  fill(levels, table, passes);
  while (level_begin_.size() <= grid.depth) level_begin_.push_back(static_cast<uint32_t>(nodes));
}

void DeviceTree::fill(const std::vector<Level>& levels, const ShaftTable& table, gpu::PassRecorder& passes) {
  const std::vector<uint32_t> padded = padded_rows(table);
  const gpu::Buffer rows = words(passes.device(), padded.size(), "line space: shafts of subnodes");
  gpu::Image row_image;
  gpu::upload(passes, "upload_shafts", rows, padded.data(), padded.size() * sizeof(uint32_t));
  copy_words(passes, rows, row_image, "upload_shafts", 4);
  passes.finish();
  shafts_.bind_images(std::array{row_image.view()});
  const uint64_t groups_per_node = groups_of((table.words() + 3) / 4);
  level_begin_.assign(1, 0);
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const Level& level = levels[l];
    const uint32_t base = level_begin_.back();
    FillPush push{};
    push.nodes = level.nodes.address(), push.occupancy = level.occupancy.address();
    push.first_child = level.first_child ? level.first_child.address() : 0;
    push.node_pool = nodes_.address(), push.tree_pool = tree_.address();
    push.count = level.count, push.base = base, push.next_base = base + level.count;
    push.last_level = l + 1 == levels.size();
    LineSpacePush line{};
    line.occupancy = level.occupancy.address();
    line.line_space_pool = line_space_.address();
    line.count = level.count, line.base = base;
    level_begin_.push_back(base + level.count);
    if (!level.count) continue;
    passes.device_pass(
        "n_tree", [&](gpu::Commands& commands) { commands.dispatch(fill_, push, groups_of(level.count)); });
    passes.device_pass("line_space", [&](gpu::Commands& commands) {
      commands.dispatch(shafts_, line, level.count * groups_per_node);
    });
  }
  copy_to_images(passes);
  passes.finish();
}

Pools DeviceTree::download(const Grid& grid, gpu::PassRecorder& passes) const {
  const uint64_t count = level_begin_.back(), n = grid.branching;
  Pools pools;
  pools.level_begin = level_begin_;
  pools.tree.resize(count * n * n * n);
  pools.nodes.resize(count);
  pools.line_space.resize(pool_bytes(grid.branching, count).line_space / 4);
  gpu::download(passes, "download_tree", tree_, pools.tree.data(), pools.tree.size() * 4);
  gpu::download(passes, "download_tree", nodes_, pools.nodes.data(), count * sizeof(Node));
  gpu::download(passes, "download_tree", line_space_, pools.line_space.data(), pools.line_space.size() * 4);
  passes.finish();
  return pools;
}

}  // namespace penumbra::line_space
