#pragma once
/// A material map felt over the patch that a press makes, so that a contrast within it pushes
/// sideways no harder than the wall pushes back.

#include "palpate/materials/material.h"

namespace palpate {

/// The mean of a map over a patch, and what it changes by.
struct PatchSample {
  double value = 0.0;  ///< [unit of the map]
  /// [the same per m] where the middle moves and the press stays as it is, ...
  Vec3 by_place{0.0, 0.0, 0.0};
  /// ... and the other way round
  Vec3 by_press{0.0, 0.0, 0.0};
};

/// [m] Radius of the patch of a press `depth` [m] deep. `contrast` [m]: over what length the map
/// changes by as much as it is, at its steepest. Down to half of that depth the patch is a point:
/// there a contrast pushes sideways a quarter as hard as the wall pushes back, at most. Far below
/// it is as wide as the press is deep.
[[nodiscard]] double patchRadius(double depth, double contrast) noexcept;

/// The mean of `map` about `middle` [m], for a press that goes from the hand to the proxy by
/// `press` [m], not zero. The places are those of a sphere, flattened across the press: along any
/// line they are spread evenly. One sample where the radius is 0, else 24, and 96 where it is more
/// than 16 times `contrast` (between, both, blended). Real-time safe.
[[nodiscard]] PatchSample overPatch(const Parameter& map, const Vec3& middle, const Vec3& press,
                                    double contrast) noexcept;

}  // namespace palpate
