#pragma once
/// Images whose voxels are signed distances.

#include <optional>
#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// The median length of the gradient [per m] over all voxels beside which the values change their
/// sign; nothing if the values do not change their sign, or none of them is a number.
[[nodiscard]] std::optional<double> slopeAtZero(const Image& image);

/// Whether the values look like signed distances in mm: both signs occur, and the slope where they
/// are zero is 1 within a fifth.
[[nodiscard]] bool looksLikeDistances(const Image& image);

/// Why such an image should not be thresholded as "inside is greater". Empty: there is no
/// objection.
[[nodiscard]] std::string distancesNote(const Image& image);

}  // namespace palpate::vdb
