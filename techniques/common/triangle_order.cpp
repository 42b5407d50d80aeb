#include "techniques/common/triangle_order.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"
#include "samples/view_samples.h"

namespace penumbra {
namespace {

constexpr std::size_t max_outside = 32;
constexpr float outside_share = 0.25f;  // of the scene's diagonal
constexpr std::size_t most_weighed = 1024;

struct Item {
  Vec3f center;
  uint32_t triangle = 0;
  Box box;
};

uint64_t spread(uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

Box centers(const Item* begin, const Item* end) {
  Box box;
  for (const Item* i = begin; i != end; ++i) box.extend(i->center);
  return box;
}

Box boxes(const Item* begin, const Item* end) {
  Box box;
  for (const Item* i = begin; i != end; ++i) box.extend(i->box.lo), box.extend(i->box.hi);
  return box;
}

// Of a box's surface, half: as likely does a line meet it that meets the box around it.
float surface(const Box& box) {
  const Vec3f d = box.hi - box.lo;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

bool before(const Item& a, const Item& b, int axis) {
  return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.triangle < b.triangle;
}

struct Cut {
  int axis = 0;
  std::size_t left = 0;  // items before the cut
};

// Many items: in the middle, across the longest axis.
Cut middle_cut(const Item* begin, const Item* end, std::size_t capacity) {
  const std::size_t count = static_cast<std::size_t>(end - begin);
  const Vec3f size = [&] {
    const Box box = centers(begin, end);
    return box.hi - box.lo;
  }();
  const std::size_t parts = (count + capacity - 1) / capacity;
  return {size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2, (parts + 1) / 2 * capacity};
}

// Few items: where both sides' boxes have least surface, each weighted by its parts.
Cut best_cut(const Item* begin, const Item* end, std::size_t capacity) {
  std::vector<Item> items(begin, end);
  const std::size_t parts = (items.size() + capacity - 1) / capacity;
  std::vector<float> cost(parts);
  Cut best;
  float least = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::sort(items, [axis](const Item& a, const Item& b) { return before(a, b, axis); });
    const Item *first = items.data(), *last = first + items.size();
    Box left, right;
    const auto grow = [](Box& box, const Box& more) { box.extend(more.lo), box.extend(more.hi); };
    for (std::size_t k = 1; k < parts; ++k) {
      grow(left, boxes(first + (k - 1) * capacity, first + k * capacity));
      cost[k] = surface(left) * static_cast<float>(k);
    }
    for (std::size_t k = parts - 1; k > 0; --k) {
      grow(right, boxes(first + k * capacity, std::min(first + (k + 1) * capacity, last)));
      cost[k] += surface(right) * static_cast<float>(parts - k);
      if (cost[k] < least) least = cost[k], best = {axis, k * capacity};
    }
  }
  return best.left > 0 ? best : middle_cut(begin, end, capacity);
}

void sort_by_morton(std::vector<Item>& items) {
  const Box box = centers(items.data(), items.data() + items.size());
  const Vec3f size = box.hi - box.lo;
  const float scale = 2097151.0f / std::max({size.x, size.y, size.z, 1e-30f});
  std::vector<std::pair<uint64_t, uint32_t>> keys(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Vec3f q = (items[i].center - box.lo) * scale;
    keys[i] = {spread(static_cast<uint64_t>(q.x)) | spread(static_cast<uint64_t>(q.y)) << 1 |
                   spread(static_cast<uint64_t>(q.z)) << 2,
               items[i].triangle};
  }
  std::ranges::sort(keys);
  for (std::size_t i = 0; i < items.size(); ++i) items[i].triangle = keys[i].second;
}

// Cuts [begin, end) into parts of `capacity` items by binary cuts between parts, then each part into parts of
// capacity / arity, down to leaves.
void cut(Item* begin, Item* end, std::size_t capacity, std::size_t arity) {
  const std::size_t count = static_cast<std::size_t>(end - begin);
  if (count <= arity) return;
  if (count <= capacity) return cut(begin, end, capacity / arity, arity);
  const Cut at = count <= most_weighed ? best_cut(begin, end, capacity) : middle_cut(begin, end, capacity);
  Item* const middle = begin + at.left;
  std::nth_element(begin, middle, end,
                   [axis = at.axis](const Item& a, const Item& b) { return before(a, b, axis); });
  if (count < 4096) {
    cut(begin, middle, capacity, arity);
    cut(middle, end, capacity, arity);
    return;
  }
  parallel_for(2, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      i == 0 ? cut(begin, middle, capacity, arity) : cut(middle, end, capacity, arity);
  });
}

// Leaves out of `items` the triangles that are to stay outside the tree.
std::vector<uint32_t> take_outside(const Geometry& geometry, std::vector<Item>& items) {
  struct Large {
    float extent;
    uint32_t triangle;
  };
  std::vector<Large> large;
  const float limit = outside_share * geometry.bounds.diagonal();
  for (const Item& item : items) {
    Box box;
    for (int k = 0; k < 3; ++k) box.extend(geometry.corner(item.triangle, k));
    if (box.diagonal() > limit) large.push_back({box.diagonal(), item.triangle});
  }
  std::ranges::sort(large, [](const Large& a, const Large& b) {
    return a.extent != b.extent ? a.extent > b.extent : a.triangle < b.triangle;
  });
  large.resize(std::min(large.size(), max_outside));
  std::vector<uint32_t> outside;
  for (const Large& l : large) outside.push_back(l.triangle);
  std::ranges::sort(outside);
  std::erase_if(items, [&](const Item& i) { return std::ranges::binary_search(outside, i.triangle); });
  return outside;
}

}  // namespace

TriangleOrder order_triangles(const Geometry& geometry, uint32_t arity, SpatialOrder kind) {
  std::vector<Item> items(geometry.triangle_count());
  parallel_for(items.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3f a = geometry.corner(t, 0), b = geometry.corner(t, 1), c = geometry.corner(t, 2);
      items[t] = {
          (a + b + c) * (1.0f / 3.0f), static_cast<uint32_t>(t), {min(min(a, b), c), max(max(a, b), c)}};
    }
  });
  const std::vector<uint32_t> outside = take_outside(geometry, items);
  TriangleOrder order;
  const uint32_t count = static_cast<uint32_t>(items.size());
  const uint32_t leaves = std::max((count + arity - 1) / arity, 1u);
  order.leaf_count =
      (leaves + arity - 1) / arity * arity;  // siblings all exist, empty where there is nothing
  order.tree_slots = order.leaf_count * arity;
  // At least one level of inner nodes; all of them exist, so the tree ends after the last leaf's siblings.
  std::size_t capacity = arity;
  for (uint32_t level = 1; order.first_leaf == 0 || level < order.leaf_count;) {
    order.first_leaf += level;
    level *= arity;
    capacity *= arity;
  }
  order.node_count = order.first_leaf + order.leaf_count;
  if (kind == SpatialOrder::morton)
    sort_by_morton(items);
  else if (!items.empty())
    cut(items.data(), items.data() + items.size(), capacity / arity, arity);
  order.slots.assign(order.tree_slots, no_triangle);
  for (std::size_t i = 0; i < items.size(); ++i) order.slots[i] = items[i].triangle;
  order.slots.insert(order.slots.end(), outside.begin(), outside.end());
  return order;
}

}  // namespace penumbra
