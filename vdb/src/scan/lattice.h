#pragma once
/// An image's own values near a threshold.

#include "scan/band.h"

namespace palpate::vdb {

/// The image's values minus `above`, with the sign such that the mask's inside is negative, in the
/// band of the mask: finite, never 0. Where `mask` is what the threshold alone gives, the values
/// put the surface between two voxels; where it is not (a piece removed, a cavity filled) their
/// sign is flipped. `spacing` as for bandOf().
[[nodiscard]] Band bandOfThreshold(const Image& image, double above, const Mask& mask,
                                   const Vec3& spacing);

}  // namespace palpate::vdb
