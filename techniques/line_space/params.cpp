#include "techniques/line_space/params.h"

namespace penumbra::line_space {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer("branching", &Params::branching, 2, 10,
              {"", "N", "A subdivided node has N x N x N subnodes; each of its sides has N x N subsides."})
        .cost();
    t.integer("depth", &Params::depth, 1, 6,
              {"", "d",
               "How often nodes are subdivided: the finest subdivided nodes form a grid of N^(d-1) a side."})
        .cost();
    t.choice("build", &Params::build, {"host", "device"},
             {"", "", "Where tree and line space are made: on all host threads, or by compute shaders."});
    t.choice("backend", &Params::backend, {"vulkan", "cpu"},
             {"", "", "What follows the shadow segments through the tree: the Vulkan device, or the host."});
    t.choice("cells", &Params::cells, {"fitted", "cubic"},
             {"", "",
              "Shape of the root node: the box of the triangles in it, or a cube about that box (nodes are "
              "then cubes)."});
    t.choice(
        "start", &Params::start, {"node", "neighbours", "coarse"},
        {"", "",
         "What is skipped where a segment begins: the finest subdivided node there, as the source says; that "
         "and those which touch it; or the whole child of the root."});
    t.boolean("bounding_faces", &Params::bounding_faces,
              {"", "",
               "Keep triangles in a face of the scene's bounding box, such as a ground plane. They cannot "
               "block, and are left out where all light samples are on the inner side."});
    t.integer("memory_limit_mib", &Params::memory_limit_mib, 1, 65536,
              {"MiB", "", "Points whose tree and line space, or lists while building, need more fail."});
    return t;
  }();
  return table;
}

}  // namespace penumbra::line_space
