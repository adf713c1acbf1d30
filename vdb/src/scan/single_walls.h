#pragma once
/// Finds places where a wall, or a gap, is a single voxel of a mask.

#include <array>
#include <cstddef>

#include "scan/mask.h"

namespace palpate::vdb {

/// Whether a voxel of the box alone separates its two neighbors along `axis`, which are both on the
/// other side: among the 26 voxels around it, no path on that other side connects the two, by the
/// faces and edges that connect a mask's voxels. Over a lone voxel on a body there is such a path.
[[nodiscard]] bool isSingleWall(const Mask& mask, const std::array<int, 3>& at,
                                std::size_t axis) noexcept;

}  // namespace palpate::vdb
