// gears with `backend: cpu`: the same algorithm on the host's vector units and threads.
#pragma once
#include <memory>

#include "technique/technique.h"
#include "techniques/gears/params.h"

namespace penumbra::gears::cpu {

std::unique_ptr<Technique> make_backend(const GearsParams& params);

}  // namespace penumbra::gears::cpu
