#pragma once
/// Where the proxy begins when the HIP is not in the start region.

#include "cell_walker.h"

namespace palpate {

/// A point of the scene's start region close to `hip` [m], from which the nearest one can be
/// reached: `hip` itself if it is in the region; else the nearest of the feet on the scene's
/// leaves, of points on lines and of the region's seed; `hip` if none of these is in the region.
/// Bounded work, no allocation.
[[nodiscard]] Vec3 startPoint(const Scene& scene, CellWalker& probe, const Vec3& hip) noexcept;

}  // namespace palpate
