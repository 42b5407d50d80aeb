// A technique whose faults are parameters, to see that the runner survives them.
#pragma once
#include "technique/technique.h"

namespace penumbra::test {

// `fake`: sampled, on the host. Parameters:
//   fault   none | abort | segfault | exit | hang | throw | unsupported | nan | forget | greedy | too_large |
//   unrepeatable at      setup | build | render | tenth_frame value   the visibility that it claims sleep_ms
//   of each frame dynamic   rebuilt in every frame
// Every frame that begins is a line in the file named by PENUMBRA_TEST_LOG, if that is set.
TechniqueInfo fake_technique();
Registry fake_registry();

}  // namespace penumbra::test
