// The pictures of a point in two runs, held against the reference pixel by pixel.
#pragma once
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "compare/run_results.h"
#include "metrics/pixel_test.h"

namespace penumbra::compare {

struct PixelOutcome {
  PixelTest test;
  std::string worst;    // "(12, 40): 0.5 was 0.25, the truth is 0.26 +- 0.01"; empty when none is farther
  std::string why_not;  // why there was no test; then the rest says nothing
};

// True when the records of both runs name what the test needs: both visibilities, the reference and its
// standard error. Committed baselines have no pictures, exact references have no error.
bool has_pixels(const RunResults& baseline, const nlohmann::json& before, const RunResults& current,
                const nlohmann::json& now);

// The test's outcome. Pictures that cannot be read, differ in size, or are held against different references
// are no error but `why_not`: figures judge them still.
PixelOutcome judge_pixels(const RunResults& baseline, const nlohmann::json& before, const RunResults& current,
                          const nlohmann::json& now);

// A finding that waits for the correction by the number of all.
struct PixelCheck {
  std::size_t finding;
  PixelOutcome outcome;
  double allowed;  // share of pixels by which those farther may outnumber those nearer
};

// Gives the findings their verdicts, p values corrected by Holm: `regressed` when pixels are farther from the
// truth beyond chance *and* outnumber those nearer by more than is allowed: a cure that harms a few pixels is
// none.
void judge_pixel_checks(const std::vector<PixelCheck>& checks, double significance,
                        std::vector<Finding>& findings);

}  // namespace penumbra::compare
