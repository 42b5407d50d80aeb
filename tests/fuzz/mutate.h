// Mutations of JSON texts that break readers.
#pragma once
#include <random>
#include <string>

namespace penumbra::test {

// Other types, extremes, text that ends early, pieces twice or elsewhere, foreign bytes.
std::string mutated(std::string text, std::mt19937& random);

}  // namespace penumbra::test
