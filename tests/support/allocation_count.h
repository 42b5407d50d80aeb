// Counts what the test program that uses it allocates, in any thread and library.
#pragma once

namespace penumbra::testing {
// Calls of malloc and its like so far.
long allocation_count();
}  // namespace penumbra::testing
