#pragma once
/// How far a grid is off the field that it was made of.

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct GridError {
  double off = 0.0;   ///< [m] largest distance of the two surfaces
  double turn = 0.0;  ///< [rad] largest angle between the two gradients
  Vec3 where{0.0};    ///< [m] where the angle is largest
};

/// Looks at one point of `field`'s surface for each voxel of `grid` next to it, within `box` [m]. `made` is
/// the grid as a field.
[[nodiscard]] GridError gridError(const Field& field, const LevelSet& grid, const Field& made,
                                  const Box3& box);

}  // namespace palpate::vdb
