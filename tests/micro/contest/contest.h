// A technique on the device, all its per-frame stages, against Embree's fastest packets in one run: what the
// programs NAME_vs_embree share.
//   micro_NAME_vs_embree [SCENE ...] [key=value ...] [--benchmark_repetitions=5]
//   [--benchmark_enable_random_interleaving=true]
// Scenes are names under configs/scenes; key=value are parameters of the technique, or k=16,32 (k x k light
// samples), resolution=512 and light=NAME (a light of the scenes; the first by default). The opponent is
// ray_tracing, not robust, with packets of 8 and 16 rays and both coherence hints: the fastest of the four
// counts. The table ends with the ratio of the medians.
#pragma once
#include <string>
#include <vector>

#include "technique/params.h"

namespace penumbra::contest {

struct Options {
  std::string technique, light;
  std::vector<std::string> scenes;
  std::vector<int> k;
  int resolution = 512;
  ParamValues params;
};

// `options`: what holds where the command line says nothing. Returns the program's exit code.
int run(int argc, char** argv, Options options);

}  // namespace penumbra::contest
