#pragma once
/// Where the proxy begins when the HIP is not in the start region.

#include "cell_walker.h"

namespace palpate {

/// A point of the scene's start region close to `hip` [m]: `hip` itself if it lies there, else the nearest
/// that lines in many directions meet, else the region's seed. Bounded work, no allocation.
[[nodiscard]] Vec3 startPoint(const Scene& scene, CellWalker& probe, const Vec3& hip) noexcept;

}  // namespace palpate
