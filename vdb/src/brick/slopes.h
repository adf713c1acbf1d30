#pragma once
/// How steep an interpolant can be.

#include <array>
#include <cstddef>

namespace palpate::vdb {

/// A bound of |gradient|^2, in values a step, of the cubic B-spline or the trilinear interpolant
/// with the `side`^3 coefficients at `first` and on, at most kMostSide^3, in all cells whose
/// stencils lie among them; from one to the next along x and y there are `strides`, along z none is
/// between.
///
/// Along an axis the slope of either is a mean of the differences between neighbors. These can be
/// shared out among the coefficients, each of which takes a mean of the one before and the one
/// after it, so that the means weigh as much in the slope as the coefficients in the value: for the
/// cubic spline with weights w0..w3 and those of its slope q0..q2, coefficient 1 takes the share
/// (q0 - w0) / w1 of the first difference, which is from 0 to 1, and 2 likewise. The three
/// components of the gradient then have the same weights, those of the value, and none is longer
/// than the longest of the vectors that they are means of.
[[nodiscard]] double steepestSquare(const float* first, std::size_t side,
                                    const std::array<std::size_t, 2>& strides) noexcept;
inline constexpr std::size_t kMostSide = 16;

}  // namespace palpate::vdb
