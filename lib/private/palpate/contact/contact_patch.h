#pragma once
/// A material map felt over the patch that a press makes, so that a contrast within it pushes
/// sideways no harder than the wall pushes back.

#include "palpate/materials/material.h"

namespace palpate {

/// The mean of a map over a patch, and its gradients.
struct PatchSample {
  double value = 0.0;  ///< [unit of the map]
  /// [unit per m] gradient by the middle of the patch at constant press
  Vec3 by_place{0.0, 0.0, 0.0};
  /// [unit per m] gradient by the press at constant middle
  Vec3 by_press{0.0, 0.0, 0.0};
};

/// [m] Radius of the patch of a press `depth` [m] deep. `contrast` [m] is the length over which the
/// map, where it is steepest, changes by as much as its own value. Down to a depth of half of that
/// the patch is a point: there a contrast pushes sideways at most a quarter as hard as the wall
/// pushes back. At much larger depths the radius approaches the depth.
[[nodiscard]] double patchRadius(double depth, double contrast) noexcept;

/// The mean of `map` about `middle` [m], for a press whose way from the hand to the proxy is
/// `press` [m], not zero. The samples lie on a sphere flattened along the press, so that their
/// projections on any line in the patch are spread evenly. One sample if the radius is 0; otherwise
/// 24, or 96 if the radius is more than 16 times `contrast`; in between a blend of both. Real-time
/// safe.
[[nodiscard]] PatchSample overPatch(const Parameter& map, const Vec3& middle, const Vec3& press,
                                    double contrast) noexcept;

}  // namespace palpate
