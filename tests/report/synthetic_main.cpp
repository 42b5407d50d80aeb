// synthetic_results DIR [COUNT]: writes a synthetic run, to look at by hand.
#include <cstdio>
#include <cstdlib>

#include "synthetic_run.h"

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: synthetic_results DIR [COUNT]\n"), 2;
  if (argc > 2)
    penumbra::test::write_large_run(argv[1], std::atoi(argv[2]));
  else
    penumbra::test::write_synthetic_run(argv[1], {320, 240, true});
}
