// sample_based_soft against Embree's fastest packets; see contest/contest.h for what the command takes.
#include "tests/micro/contest/contest.h"

int main(int argc, char** argv) {
  return penumbra::contest::run(argc, argv,
                                {.technique = "sample_based_soft",
                                 .light = {},
                                 .scenes = {"bunny", "columns", "torus_knot"},
                                 .k = {16},
                                 .params = {}});
}
