#pragma once
/// Places where a wall, or a gap, is a single voxel of a mask.

#include <array>
#include <cstddef>

#include "scan/mask.h"

namespace palpate::vdb {

/// Whether a voxel of the box is all that parts its two neighbors along `axis`, which are on the
/// other side: among the 26 voxels around it no way on that side leads from one to the other, by
/// the faces and edges that join a mask's voxels. Over a lone voxel on a body there is a way.
[[nodiscard]] bool isSingleWall(const Mask& mask, const std::array<int, 3>& at,
                                std::size_t axis) noexcept;

}  // namespace palpate::vdb
