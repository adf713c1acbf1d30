#pragma once
/// Bounds of an interpolant's slope.

#include <array>
#include <cstddef>

namespace palpate::vdb {

/// A bound of |gradient|^2, in values per step, of the cubic B-spline or the trilinear interpolant
/// with the `side`^3 coefficients that begin at `first`, at most kMostSide^3, in all cells whose
/// stencils lie among them. `strides` are the steps in memory along x and y; along z the step is 1.
///
/// Along an axis the slope of either interpolant is a weighted mean of the differences between
/// neighbors. These differences can be distributed over the coefficients, so that each coefficient
/// gets a mean of the difference before it and the one after it, with the same weight in the slope
/// that the coefficient has in the value. For the cubic spline with weights w0..w3 and weights
/// q0..q2 of its slope, coefficient 1 takes the share (q0 - w0) / w1 of the first difference, which
/// is from 0 to 1, and coefficient 2 likewise. Then the three components of the gradient have the
/// same weights, those of the value, so that the gradient is a mean of vectors and no longer than
/// the longest of them.
[[nodiscard]] double steepestSquare(const float* first, std::size_t side,
                                    const std::array<std::size_t, 2>& strides) noexcept;
inline constexpr std::size_t kMostSide = 16;

}  // namespace palpate::vdb
