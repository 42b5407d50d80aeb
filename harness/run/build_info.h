// What the build knows about itself; build_info.cpp is written by build_info.cmake at every build.
#pragma once

namespace penumbra::run::build_info {

extern const char version[], commit[], build_type[], compiler[],
    flags[];  // commit: "" outside a git checkout

}  // namespace penumbra::run::build_info
