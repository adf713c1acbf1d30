#pragma once
/// How thick a region is: the scale of what is felt within it.

#include <span>

#include "palpate/scene/scene.h"

namespace palpate {

/// [m] Across the largest ball that is found in the region by climbing from a point of it, its
/// seed; infinite where it has no end. For set-up.
[[nodiscard]] double thicknessOf(std::span<const Region> regions, std::size_t region);

}  // namespace palpate
