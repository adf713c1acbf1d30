#pragma once
/// Images whose voxels are signed distances.

#include <optional>

#include "palpate/vdb/image.h"

namespace palpate::tools {

/// The median length of the gradient [per m] in the voxels beside which the values change their sign, over all of
/// the image; nothing if the values do not change their sign, or have none that is a number.
[[nodiscard]] std::optional<double> slopeAtZero(const vdb::Image& image);

/// Whether they look like signed distances in mm: both signs, and a slope of 1 within a fifth where they are zero.
[[nodiscard]] bool looksLikeDistances(const vdb::Image& image);

}  // namespace palpate::tools
