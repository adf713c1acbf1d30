#pragma once
/// Bounds of the sampled function between voxels, derived from coefficients, not from samples.

#include <array>
#include <cstdint>
#include <limits>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// Bounds over the cells of some bricks. In a cell the cubic spline is a polynomial, which lies
/// between the smallest and the largest of its control values (Bernstein form, computed from the
/// spline's coefficients). The same holds for its derivatives, whose control values are differences
/// of those. Trilinear cells are bounded by their corners.
struct BandBounds {
  using Voxel = std::array<int, 3>;

  /// [voxels] |value| is at least this in the cells that do not answer; infinite if all do.
  double least_unknown = std::numeric_limits<double>::infinity();
  Voxel unknown_at{};  ///< first voxel of that cell
  /// [-] The least bound of the slope along one direction, over the cells that may hold the
  /// surface. Not above 0: an edge, a cusp, or a thin part.
  double least_slope = std::numeric_limits<double>::infinity();
  Voxel slope_at{};
  /// [-] No slope is steeper than this in cells that answer and have a value nearer to 0 than
  /// kNear.
  double steepest_near = 1.0;
  std::uint64_t surface_cells = 0;  ///< that may hold the surface
  std::uint64_t rough_cells = 0;    ///< of these, the ones whose slope may be below kSmoothSlope
  double least_way = 0.0;           ///< [voxels] from LeastWay, if that was computed

  void add(const BandBounds& other) noexcept;
  /// [voxels] Lower bound of the distance from the surface to a point that does not answer: on the
  /// path there |value| rises to least_unknown or kNear, and no slope before that is above
  /// steepest_near. Or least_way, if that is more.
  [[nodiscard]] double within() const noexcept;

  /// Adds all cells of the brick; `first` is its first voxel, and no slope in it is above
  /// `steepest`.
  void add(const Brick& brick, const Voxel& first, bool cubic, double steepest) noexcept;

  static constexpr double kNear = 1.5;  ///< [voxels]
};

/// If no slope of a brick is above this, it is not worth finding slopes cell by cell.
inline constexpr double kNotSteep = 1.3;

/// [-] A bound of the slopes of the cubic spline in the brick's cells. Takes some 0.1 ms. Where
/// distances to several sides meet it is far lower than the bound from differences of coefficients:
/// at a kink the prefilter makes coefficients jump by up to nine times as much as the spline.
[[nodiscard]] double steepestInCells(const Brick& brick) noexcept;

/// No cell of a sphere of two voxels has a smaller bound of its slope.
inline constexpr double kSmoothSlope = 0.4;

}  // namespace palpate::vdb
