#pragma once
/// How far a grid is off the field that it was made from.

#include <cstddef>
#include <limits>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct GridError {
  double off = 0.0;   ///< [m] largest distance between the two surfaces
  double turn = 0.0;  ///< [rad] largest angle between the two gradients
  Vec3 where{0.0};    ///< [m] where the angle is largest
};

/// Compares, within `box` [m], one point of `field`'s surface for each voxel of `grid` next to it.
/// `made` is the grid as a field. If there are more than `most_blocks` blocks of 8^3 voxels, only
/// that many are compared.
[[nodiscard]] GridError gridError(
    const Field& field, const LevelSet& grid, const Field& made,
    const Box3& box = Box3::everything(),
    std::size_t most_blocks = std::numeric_limits<std::size_t>::max());

/// The error that a sampler stays within where the surface bends over some four voxels or more:
/// 0.02 voxel and 1 degree for the cubic one, 0.1 and 10 for the others. At an edge the error is
/// far larger.
[[nodiscard]] GridError smoothGridError(Sampler sampler, double voxel_size) noexcept;

}  // namespace palpate::vdb
