#include "techniques/gears/params.h"

namespace penumbra {

const ParamTable<GearsParams>& gears_params() {
  using P = GearsParams;
  static const ParamTable<P> table = [] {
    ParamTable<P> t;
    t.integer(
         "grid_size", &P::grid_size, 1, 1024,
         {"cells", "G",
          "Cells along a side of the grid that assignment=triangles assigns view samples and triangles to."})
        .axis();
    t.choice(
        "assignment", &P::assignment, {"triangles", "clusters"},
        {"", "T_uv",
         "How view samples find their triangles: the paper's grid of triangles, or a refitted box tree that "
         "groups of view samples walk together."});
    t.choice(
        "extrusion_length", &P::extrusion_length, {"conservative", "paper"},
        {"", "F_ij",
         "Where a triangle's shadow volume ends: at the farthest view sample, or, as the slides have it, at "
         "twice the vertex's distance from the light, which can miss what lies farther."});
    t.choice("backend", &P::backend, {"vulkan", "cpu"},
             {"", "", "What computes: the Vulkan device, or the host."});
    t.choice(
        "triangle_order", &P::triangle_order, {"morton", "kd"},
        {"", "",
         "Order of the triangles in the box tree, made once: a Morton curve, or cuts in the middle of the "
         "longest "
         "axis and, of up to 1024 triangles, where boxes get smallest (slower to make, tighter boxes)."});
    t.integer("list_budget_mib", &P::list_budget_mib, 1, 16384,
              {"MiB", "",
               "Memory for the cells' lists of triangles; cells that need more are done in several turns."});
    t.integer("leaf_batch", &P::leaf_batch, 1, 32,
              {"leaves", "", "Leaves that a group collects before it rasterises their triangles."});
    t.integer("dispatch_turns", &P::dispatch_turns, 64, 20000,
              {"loop turns", "",
               "Work of a group in one dispatch; then it writes down where it is and goes on in the next."});
    t.integer("split_turns", &P::split_turns, 64, 20000,
              {"loop turns", "",
               "Work after which a group of view samples goes on as two, cut where they lie farthest apart "
               "(assignment=clusters)."});
    t.number("depth_weight", &P::depth_weight, 0.0, 4.0,
             {"", "",
              "Weight of the distance to the light, against that across, where view samples are grouped."});
    return t;
  }();
  return table;
}

}  // namespace penumbra
