#pragma once
/// The thickness of a region: the length scale of its content.

#include <span>

#include "palpate/scene/scene.h"

namespace palpate {

/// [m] Diameter of the largest ball that is found in the region by climbing from its seed point;
/// infinite where it has no end. For set-up.
[[nodiscard]] double thicknessOf(std::span<const Region> regions, std::size_t region);

}  // namespace palpate
