#pragma once
/// What the function out of bricks can be between voxels, bounded and not sampled.

#include <array>
#include <cstdint>
#include <limits>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// Bounds over the cells of some bricks. In a cell the cubic spline is a polynomial, which lies
/// between the least and the largest of its control values (Bernstein's form, made of the spline's
/// coefficients); so do its derivatives, whose control values are differences of those. Trilinear
/// cells are bounded by their corners.
struct BandBounds {
  using Voxel = std::array<int, 3>;

  /// [voxels] |value| is at least that in the cells that do not answer; infinite if all do.
  double least_unknown = std::numeric_limits<double>::infinity();
  Voxel unknown_at{};  ///< first voxel of that cell
  /// [-] The slope along one direction, in the cell where its bound is least among those that may
  /// hold the surface. Not above 0: an edge, a cusp, or a thin part.
  double least_slope = std::numeric_limits<double>::infinity();
  Voxel slope_at{};
  /// [-] No slope is steeper in cells that answer and have a value nearer to 0 than kNear.
  double steepest_near = 1.0;
  std::uint64_t surface_cells = 0;  ///< that may hold the surface
  std::uint64_t rough_cells = 0;    ///< of these, the ones whose slope may be below kSmoothSlope
  double least_way = 0.0;           ///< [voxels] by LeastWay, if it was asked for

  void add(const BandBounds& other) noexcept;
  /// [voxels] How far it is at least from the surface to a point that does not answer: on the way
  /// there |value| rises to least_unknown or kNear, and until then no slope is above steepest_near.
  /// Or least_way, if that is more.
  [[nodiscard]] double within() const noexcept;

  /// All cells of the brick; `first` is its first voxel, and no slope in it is above `steepest`.
  void add(const Brick& brick, const Voxel& first, bool cubic, double steepest) noexcept;

  static constexpr double kNear = 1.5;  ///< [voxels]
};

/// Where no slope of a brick is above that, it is not worth to know it cell by cell.
inline constexpr double kNotSteep = 1.3;

/// [-] No slope of the cubic spline in the brick's cells is above that. Takes some 0.1 ms, and says
/// far less than the differences of coefficients where distances to several sides meet: the
/// spline's filter lets coefficients leap at a kink by up to nine times what the spline does.
[[nodiscard]] double steepestInCells(const Brick& brick) noexcept;

/// A sphere of two voxels has no cell with a smaller bound of its slope.
inline constexpr double kSmoothSlope = 0.4;

}  // namespace palpate::vdb
