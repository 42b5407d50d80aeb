// The colour spaces of FLIP [Andersson 2020, sec. 4.1].
#pragma once
#include "core/vec.h"

namespace penumbra::flip_color {

// Linear sRGB, clamped to [0, 1], to the opponent space Y Cx Cz in which the eye's blur is applied, without
// its constants: Y = 116 y - 16, Cx = 500 (x - y), Cz = 200 (y - z) with x y z relative to the white; given
// are y, x - y, y - z. Filters whose weights sum to 1 leave the constants as they are, and rounding does not
// suffer from them near black.
Vec3f opponent_from_linear(Vec3f rgb);
// The opponent colour, clamped to the sRGB gamut, to Lab whose chroma shrinks with the lightness (Hunt's
// effect).
Vec3f hunt_lab_from_opponent(Vec3f opponent);
// |dL| + |d(a, b)|: a distance that holds for large differences too.
float hyab(Vec3f p, Vec3f q);

}  // namespace penumbra::flip_color
