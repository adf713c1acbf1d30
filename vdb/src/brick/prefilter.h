#pragma once
/// Computes the contents of one brick from the grid's values.

#include <array>
#include <cstdint>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// The voxels that one brick's coefficients depend on: from -3 to 11 of its block along each axis,
/// in rows along z with one unused float each.
struct Neighborhood {
  static constexpr int kFirst = -3;
  static constexpr int kSide = 15;
  static constexpr int kRow = 16;
  static constexpr int kSlab = kSide * kRow;

  alignas(64) std::array<float, std::size_t{kSide} * kSlab> values{};  ///< [units]
  /// Bit n of row x * kSide + y: voxel kFirst + n along z is in the band. For other voxels only the
  /// sign counts.
  std::array<std::uint16_t, std::size_t{kSide} * kSide> known{};
};

/// Coefficients of the cubic B-spline that stays closest to the grid's values f. D is the sum of
/// the second differences d2 along the axes, and d4 the sum of the fourth differences, per axis and
/// in voxels:
///   c = f - D/6 + D(D)/72 + 11/720 d4
/// This is the inverse of the spline's own smoothing, 1 + d2/6 along each axis, to fourth order,
/// plus a term of 1/720 d4: interpolation has an error of -t^2 (1 - t)^2 f''''/24 between voxels,
/// which is -f''''/720 in the mean, and the term removes this mean. Where the band does not hold
/// the neighbors that D(D) needs, c = f - D/6 is used; where it does not even hold those of D, the
/// cell is not known, and c is f, limited to `plateau`. A voxel outside the band counts as
/// `plateau` [units], with its sign.
void fillCubic(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

/// The values themselves, for trilinear interpolation.
void fillLinear(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

}  // namespace palpate::vdb
