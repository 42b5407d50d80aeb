#include "techniques/common/view_texels.h"

namespace penumbra {

void ViewTexels::ensure(gpu::Device& device, gpu::PassRecorder& passes, std::size_t pixels) {
  for (TexelArray* t : {&origin, &position, &normal})
    t->ensure(device, passes, pixels, "view samples for fetching");
}

void ViewTexels::copy_from(gpu::Commands& commands, const ViewSamples& samples, std::size_t pixels) const {
  origin.copy_from(commands, samples.origin(), pixels);
  position.copy_from(commands, samples.position(), pixels);
  normal.copy_from(commands, samples.geometric_normal(), pixels);
}

}  // namespace penumbra
