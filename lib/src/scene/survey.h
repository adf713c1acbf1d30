#pragma once
/// Finds which regions exist and which of them touch, by following lines through the scene.

#include <span>
#include <vector>

#include "palpate/interior/partition.h"

namespace palpate {

struct Survey {
  std::size_t regions = 0;
  std::vector<bool> touch;     ///< [a * regions + b], symmetric
  std::vector<bool> has_seed;  ///< a point of the region was found
  std::vector<Vec3> seed;      ///< [m] that point, as deep inside the region as the lines found

  [[nodiscard]] bool touches(RegionId a, RegionId b) const { return touch[a * regions + b]; }
};

/// Follows lines along the axes and at random (fixed seed) through `boxes`, one for each layer.
/// Every step over which the region changes is bisected down to the wall itself. Features smaller
/// than about a hundredth of every box may be missed.
[[nodiscard]] Survey survey(const Partition& partition, std::span<const Box3> boxes,
                            std::size_t lines_per_box);

}  // namespace palpate
