#pragma once
/// Images whose voxels are signed distances.

#include <optional>
#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// The median length of the gradient [per m] in the voxels beside which the values change their
/// sign, over all of the image; nothing if the values do not change their sign, or have none that
/// is a number.
[[nodiscard]] std::optional<double> slopeAtZero(const Image& image);

/// Whether they look like signed distances in mm: both signs, and a slope of 1 within a fifth where
/// they are zero.
[[nodiscard]] bool looksLikeDistances(const Image& image);

/// What is wrong with taking what is greater than a threshold for the inside of such an image.
/// Empty: nothing.
[[nodiscard]] std::string distancesNote(const Image& image);

}  // namespace palpate::vdb
