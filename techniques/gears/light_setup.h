// What a light means to the room: how its masks are laid out, the space to work in, and the grid camera C.
#pragma once
#include "samples/light_samples.h"
#include "scene/scene.h"
#include "techniques/common/mask_layout.h"
#include "techniques/gears/params.h"
#include "techniques/gears/shaders/shared.h"

namespace penumbra::gears {

// Everything but the addresses. `bounds` is the geometry's.
FrameConstants frame_constants(const Light& light, const LightSamples& samples, const MaskLayout& layout,
                               const Box& bounds, GearsParams::Extrusion extrusion);

}  // namespace penumbra::gears
