#pragma once

namespace penumbra::gpu {

// Called once an instance is there. In builds with the address sanitizer it keeps drivers loaded, so that the
// leak checker can tell their leaks from ours; otherwise it does nothing.
void keep_drivers();

}  // namespace penumbra::gpu
