// Pictures of how a technique came to its answer, for people: figures per view sample or per texel, classes,
// and lines in the scene. A technique that has some derives from Illustrated beside Technique; it hands out
// what is to be shown, and the harness draws it ("diagnostics" among a config's images).
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace penumbra {

// One figure per pixel of the picture, row-major, not negative; NaN: none. Drawn in false colour over the
// dimmed scene.
struct PixelFigures {
  std::vector<float> values;
};

// One class per pixel, an index into `names`; no_class: none.
inline constexpr uint8_t no_class = 255;
struct PixelClasses {
  std::vector<uint8_t> values;
  std::vector<std::string> names;  // at most 8
};

// Figures of a grid of its own (a light's view), row-major, row 0 on top, not negative; and polygons over it
// in its cells as units: an outer one in one colour, an inner one in another.
struct GridFigures {
  int width = 0, height = 0;
  std::vector<float> values;
  std::vector<std::vector<Vec2d>> outer, inner;  // closed
  std::string outer_name, inner_name;
};

// Line segments in the world, homogeneous: w = 0 is a direction, a point at infinity. What the scene hides
// of them is drawn faintly.
struct WorldLines {
  struct Segment {
    Vec4f a, b;
    uint8_t kind = 0;  // index into `kinds`; later kinds are drawn over earlier ones
  };
  std::vector<Segment> segments;
  std::vector<std::string> kinds;  // at most 8
};

struct Illustration {
  std::string name;   // a word for file names: letters, digits and '_'
  std::string title;  // what is seen, in one line, with the unit of its figures
  std::variant<PixelFigures, PixelClasses, GridFigures, WorldLines> content;
};

class Illustrated {
 public:
  virtual ~Illustrated() = default;
  // Of the last render(), whose output it must not change. Never timed; may be slow.
  virtual std::vector<Illustration> illustrations() = 0;
};

// Every `n`-th of `count` things so that at most `most` are taken: n.
inline std::size_t every_nth(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

}  // namespace penumbra
