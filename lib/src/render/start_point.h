#pragma once
/// Where the proxy begins when the HIP is not in the start region.

#include "cell_walker.h"

namespace palpate {

/// A point of the scene's start region close to `hip` [m], from where the nearest one can be
/// reached: `hip` itself if it lies there, else the nearest of the feet on the scene's leaves, of
/// points on lines and of the region's seed. Bounded work, no allocation. If no point of it is
/// found, `hip`.
[[nodiscard]] Vec3 startPoint(const Scene& scene, CellWalker& probe, const Vec3& hip) noexcept;

}  // namespace palpate
