// Errors. Bugs are asserts; bad input and failing resources are exceptions of these types; an outcome that is
// expected (a technique that cannot do a case) is a return value, never an exception.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace penumbra {

// The user's input is wrong: file, place in it, what was found and what was expected are in the message.
// Ends the program with exit code 2 before anything runs.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// No usable device: exit code 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Results cannot be written: exit code 4.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A point cannot be finished (out of memory, device lost, a list larger than the device can hold):
// the point becomes `failed` with this message, the sweep goes on.
struct PointError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What supports() cannot foresee, because only the view samples show it: a technique cannot do this point
// after all. It becomes `unsupported` with this message, a full sentence.
struct UnsupportedError : PointError {
  using PointError::PointError;
};

// The candidate nearest to `name` by edit distance, or empty when none is near enough to be a plausible slip.
std::string nearest_name(const std::string& name, const std::vector<std::string>& candidates);

// " Did you mean 'x'?" or, when nothing is near, " Valid: a, b, c." - for the end of an error message.
std::string suggestion(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace penumbra
