#include "techniques/ray_tracing/params.h"

namespace penumbra {

const ParamTable<RayTracingParams>& ray_tracing_params() {
  using P = RayTracingParams;
  static const ParamTable<P> table = [] {
    ParamTable<P> t;
    t.boolean(
        "dynamic", &P::dynamic,
        {"", "",
         "Take the vertices anew and rebuild (or refit) the hierarchy every frame, as part of the frame."});
    t.choice("build_quality", &P::build_quality, {"auto", "low", "medium", "high", "refit"},
             {"", "",
              "Embree's build quality; auto is high when static and medium when dynamic. refit builds once "
              "at medium "
              "quality and then only moves the boxes."});
    t.boolean("robust", &P::robust, {"", "", "Embree's robust mode: watertight edges, slower."});
    t.choice(
        "packet", &P::packet, {"auto", "1", "4", "8", "16"},
        {"rays", "", "Rays in one call to Embree; auto is the widest that the processor has vectors for."});
    t.choice("order", &P::order, {"auto", "light", "pixels"},
             {"", "",
              "What fills a packet: neighbouring light samples of one view sample, or neighbouring pixels "
              "with one "
              "light sample. auto is light, but pixels when there are fewer light samples than rays in a "
              "packet."});
    t.choice("coherent", &P::coherent, {"auto", "on", "off"},
             {"", "",
              "Embree's coherence hint; auto is on below 200 triangles for each light sample, where it is "
              "the faster."});
    return t;
  }();
  return table;
}

}  // namespace penumbra
