// Golden images: committed pictures that a test's picture must equal up to a stated bound per pixel.
//
// To renew them after an intended change of the picture, run the test with PENUMBRA_RENEW_GOLDEN=1, for
// example
//     PENUMBRA_RENEW_GOLDEN=1 ctest --test-dir build -R golden
// and look at what `git diff` shows before it is committed. A renewing run fails on purpose, so that a
// forgotten variable can never make tests green that compare with nothing.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "image/image.h"

namespace penumbra::test {

// How far a picture may be from its golden one. The reason for any bound but 0 belongs beside the call.
struct GoldenBound {
  int per_channel = 0;  // largest difference of a channel's 8-bit code that is no difference
  double share_beyond =
      0;  // share of the pixels that may exceed it (rasterisation may move single edge pixels)
};

// Compares `picture` with `golden` (tests/golden/NAME.png, seen from the source root, where tests run). On
// failure the message names the worst pixel and how many exceed the bound, and the picture and a map of the
// differences are left in `left_behind` (a folder; empty: build/golden/) for a look.
testing::AssertionResult matches_golden(const Rgb8Image& picture, const std::filesystem::path& golden,
                                        const GoldenBound& bound = {},
                                        const std::filesystem::path& left_behind = {});

}  // namespace penumbra::test
