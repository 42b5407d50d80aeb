#include "techniques/sample_based_soft/params.h"

namespace penumbra::sample_based_soft {

const ParamTable<Params>& param_table() {
  using P = Params;
  static const ParamTable<P> table = [] {
    ParamTable<P> t;
    t.integer(
         "grid_size", &P::grid_size, 1, 1024,
         {"lists", "SM",
          "Lists of view samples along a side of the light's view; changes the cost, never the picture."})
        .axis();
    t.choice("half_spaces", &P::half_spaces, {"exact", "table"},
             {"", "",
              "How the light samples behind the plane through a view sample and an edge are found: "
              "evaluated, or looked up."});
    t.integer("table_size", &P::table_size, 8, 256,
              {"entries", "LU", "Entries of the lookup table along each of two angles and a distance."});
    t.choice("regions", &P::regions, {"blocks", "triangles"},
             {"", "",
              "What an influence region is made for: each triangle, as the paper has it, or a block of "
              "neighbouring triangles that a subgroup then tests one by one."});
    t.choice("far_plane", &P::far_plane, {"list", "scene"},
             {"", "",
              "Where influence regions are taken: at the farthest view sample of each list, or, as the paper "
              "has it, of the scene."});
    t.boolean(
        "fit", &P::fit,
        {"", "", "Fit the light's window to the projected view samples; else it covers the scene's bounds."});
    t.boolean("skip_empty_lists", &P::skip_empty_lists,
              {"", "", "Find no casters for lists without view samples."});
    t.boolean(
        "restrict_to_penumbra", &P::restrict_to_penumbra,
        {"", "", "Where no silhouette edge's influence region reaches, let one light sample stand for all."});
    t.boolean("cull_back_faces", &P::cull_back_faces,
              {"", "",
               "Leave out triangles of closed meshes that turn away from the whole light, where the light is "
               "outside the mesh's bounds."});
    t.boolean(
        "cull_supporting_planes", &P::cull_supporting_planes,
        {"", "", "Leave out triangles whose plane has the light and a group of view samples on one side."});
    t.choice("triangle_order", &P::triangle_order, {"morton", "kd"},
             {"", "",
              "What makes triangles of a block neighbours: a Morton curve, or cuts that keep boxes small."});
    t.number(
        "transparency", &P::transparency, 0, 1,
        {"", "",
         "Share of light that each triangle lets through. Above 0 visibility is the product, over the "
         "triangles that cover light samples, of each one's share weighted by its coverage; the masks stay "
         "those of opaque triangles."});
    t.boolean("coherent_shading", &P::coherent_shading,
              {"", "",
               "Shade the picture with vertex normals bent so that what turns away from the light is black; "
               "visibility stays as it is."});
    t.number("bend_weight", &P::bend_weight, 0.1, 1000,
             {"", "c", "How fast coherent shading goes over from bent to smooth normals."});
    t.integer("list_budget_mib", &P::list_budget_mib, 1, 16384,
              {"MiB", "",
               "Memory for the lists of casters; lists of view samples that need more are done in turns."});
    t.integer("dispatch_turns", &P::dispatch_turns, 64, 20000,
              {"loop turns", "",
               "Work of a group in one dispatch; then it writes down where it is and goes on in the next."});
    return t;
  }();
  return table;
}

}  // namespace penumbra::sample_based_soft
