#pragma once
/// Which regions there are and which touch, found by walking lines through the scene.

#include <span>
#include <vector>

#include "palpate/interior/partition.h"

namespace palpate {

struct Survey {
  std::size_t regions = 0;
  std::vector<bool> touch;     ///< [a * regions + b], symmetric
  std::vector<bool> has_seed;  ///< region was met
  std::vector<Vec3> seed;      ///< [m] a point of it, as deep inside it as the walk saw

  [[nodiscard]] bool touches(RegionId a, RegionId b) const { return touch[a * regions + b]; }
};

/// Walks lines along the axes and at random (fixed seed) through `boxes`, one for each layer, and
/// halves every step over which the region changes down to the wall itself. What is smaller than
/// about a hundredth of every box may be missed.
[[nodiscard]] Survey survey(const Partition& partition, std::span<const Box3> boxes,
                            std::size_t lines_per_box);

}  // namespace palpate
