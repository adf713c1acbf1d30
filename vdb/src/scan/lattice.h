#pragma once
/// An image's own values around where they cross a threshold.

#include "scan/band.h"

namespace palpate::vdb {

/// The image's values less `above`, turned so that the mask's inside is negative, in the band of
/// the mask: finite, never 0. Wherever `mask` is what the threshold alone would say, they put the
/// surface between two voxels; where it is not (a piece removed, a cavity filled) their sign is
/// turned. `spacing` as for bandOf().
[[nodiscard]] Band bandOfThreshold(const Image& image, double above, const Mask& mask,
                                   const Vec3& spacing);

}  // namespace palpate::vdb
