#pragma once
/// How steep the function in a brick can be.

#include "brick/brick_view.h"

namespace palpate::vdb {

/// A bound of |gradient|^2 in all cells of the brick: of the cubic spline with these coefficients, or
/// of the trilinear interpolant of these values.
[[nodiscard]] double steepestSquareCubic(const Brick& brick) noexcept;
[[nodiscard]] double steepestSquareLinear(const Brick& brick) noexcept;

}  // namespace palpate::vdb
