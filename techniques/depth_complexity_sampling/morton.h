// Morton codes and a parallel radix sort by them.
#pragma once
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace penumbra::depth_complexity {

// 10 bits per axis of the box.
class MortonCode {
 public:
  explicit MortonCode(const Box& box);
  uint32_t operator()(Vec3f p) const;

 private:
  Vec3f lo_;
  float scale_;
};

// A code and what it belongs to.
struct Keyed {
  uint32_t code, index;
};

// Sorts by the code's lower 30 bits, keeping the order of equal ones. `spare` is as large.
void sort_by_code(std::vector<Keyed>& keys, std::vector<Keyed>& spare);

}  // namespace penumbra::depth_complexity
