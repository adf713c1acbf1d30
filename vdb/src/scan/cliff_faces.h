#pragma once
/// Finds flat faces of a mask, such as those of a block.

#include <array>
#include <optional>

#include "scan/mask.h"

namespace palpate::vdb {

/// The axis across which a voxel of the box has the other side beside it, if it lies on a flat face
/// that ends in cliffs: followed along both other axes, to both sides, the face stays level until
/// the image ends or its next part is more than two voxels higher or lower. Where it ends in lower
/// steps, the surface may be tilted or curved; a face between cliffs tells nothing of that, so it
/// is half-way between the voxels. Nothing for voxels less than three from a cliff.
[[nodiscard]] std::optional<int> cliffFaceAxis(const Mask& mask,
                                               const std::array<int, 3>& at) noexcept;

}  // namespace palpate::vdb
