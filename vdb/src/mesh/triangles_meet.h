#pragma once
/// Whether two triangles of a mesh have points in common beyond shared corners and sides.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// Exact for the doubles as given; touching counts. Triangles with the same three corners, and
/// those with all corners in one line, never meet. Returns a common point, up to rounding.
[[nodiscard]] std::optional<Vec3> trianglesMeet(const std::vector<Vec3>& vertices,
                                                const std::array<std::uint32_t, 3>& one,
                                                const std::array<std::uint32_t, 3>& other);

}  // namespace palpate::vdb
