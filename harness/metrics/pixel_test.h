// Whether a picture is farther from the truth than another, pixel by pixel, where the truth itself is an
// estimate.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace penumbra {

// The converged reference, as independent batches of light samples have estimated it.
struct EstimatedTruth {
  std::span<const float> visibility, standard_error;  // of the mean of the batches
  int light_samples = 0;                              // of all batches together, above 0
  int batches = 8;                                    // at least 2
};

struct PixelTest {
  std::size_t pixels = 0;            // all of the picture
  std::size_t changed = 0;           // in which the two pictures differ at all
  std::size_t farther = 0;           // whose own p value is at most `level`, of being farther from the truth
  std::size_t nearer = 0;            // the same of being nearer
  double p_farther = 1;              // of all pixels together: that none is farther
  double p_nearer = 1;               // ... that none is nearer
  std::optional<std::size_t> worst;  // the pixel with the least p value of being farther; of `farther` ones
  static constexpr double level = 0.01;
};

// A changed pixel is farther from the truth exactly when the mean of `before` and `after` lies on after's
// side of it: one number, whose distance from the reference in standard errors is judged by Student's
// distribution with batches - 1 degrees of freedom. The standard error is held to be no smaller than one
// light sample's share, which is what batches that happen to agree cannot see. The pixels' p values are
// combined by Hommel's rule [Hommel 1983], which holds however they depend on each other: all pixels have the
// same light samples. Throws InputError when sizes differ.
PixelTest test_pixels(std::span<const float> before, std::span<const float> after,
                      const EstimatedTruth& truth);

// Upper tail of Student's t distribution, also far out: P(T >= t).
double student_tail(double t, int degrees_of_freedom);
// Hommel's combination of p values in any order: valid under any dependence. 1 for none.
double hommel(std::span<double> p);

}  // namespace penumbra
