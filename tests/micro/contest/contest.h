// A technique on the device, all its per-frame stages, against Embree's fastest packets in one run: what the
// programs NAME_vs_embree share.
//   micro_NAME_vs_embree [SCENE ...] [key=value ...] [--benchmark_repetitions=5]
// Scenes are names under configs/scenes. k=16,32 (k x k light samples), resolution=512, light=NAME (a light
// of the scenes; the first by default), opponents=8_on,8_off,16_on,16_off (or none), counters=true (the
// technique's, once); any other key=value is a parameter of the technique.
// The opponent is ray_tracing, not robust, with packets of 8 and 16 rays and the coherence hint on and off:
// the fastest of the four counts. A repetition is one frame of each, in random order, after one that is not
// counted. The passes of the technique and the processor time of all threads are printed as counters. The
// table ends with the ratios of the medians and their 95 % intervals.
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
  std::vector<std::string> opponents = {"8_on", "8_off", "16_on", "16_off"};
  bool counters = false;
};

// `options`: what holds where the command line says nothing. Returns the program's exit code.
int run(int argc, char** argv, Options options);

}  // namespace penumbra::contest
