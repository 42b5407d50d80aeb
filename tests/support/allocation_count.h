// Counts calls of operator new in the test program that uses it.
#pragma once

namespace penumbra::testing {
long allocation_count();
}
