#pragma once
/// Finds parts of a mask, and gaps in it, that are one voxel thin.

#include <array>

#include "scan/mask.h"

namespace palpate::vdb {

/// Whether a box index lies in the box.
[[nodiscard]] bool isIn(const Mask& mask, const std::array<int, 3>& at) noexcept;

/// Whether a voxel of the box is in a thin part of its own side, or has a thin part of the other
/// side across one of its faces. A voxel is thin if no cube of 2^3 voxels of its side contains it
/// or one of the 26 voxels around it: a lone voxel on a body is not thin, nor is the tip of a ball.
/// Voxels beyond the image count as on either side.
[[nodiscard]] bool isAtThinPart(const Mask& mask, const std::array<int, 3>& at) noexcept;

}  // namespace palpate::vdb
