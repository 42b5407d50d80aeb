// gears against Embree's fastest packets on the study's scenes; see contest/contest.h for what the command
// takes.
#include "tests/micro/contest/contest.h"

int main(int argc, char** argv) {
  return penumbra::contest::run(
      argc, argv,
      {.technique = "gears",
       .light = {},
       .scenes = {"study_city", "study_dragon4", "study_dragon3", "study_knots", "study_bunny", "study_nest",
                  "study_dragon2", "study_hair", "study_dragon1"},
       .k = {16, 32},
       .params = {}});
}
