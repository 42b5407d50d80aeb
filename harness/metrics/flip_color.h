// The colour spaces of FLIP [Andersson 2020, sec. 4.1].
#pragma once
#include "core/vec.h"

namespace penumbra::flip_color {

// Linear sRGB, clamped to [0, 1], to the opponent space Y Cx Cz (a linear cousin of Lab, fit for filtering).
Vec3f opponent_from_linear(Vec3f rgb);
// Y Cx Cz, clamped to the sRGB gamut, to Lab whose chroma shrinks with the luminance (Hunt's effect).
Vec3f hunt_lab_from_opponent(Vec3f ycxcz);
// |dL| + |d(a, b)|: a distance that holds for large differences too.
float hyab(Vec3f p, Vec3f q);

}  // namespace penumbra::flip_color
