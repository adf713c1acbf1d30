#pragma once
/// From the grid's values to the contents of one brick.

#include <array>
#include <cstdint>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// The voxels that one brick's coefficients depend on: from -3 to 11 of its block along each axis,
/// in rows along z with a float to spare.
struct Neighborhood {
  static constexpr int kFirst = -3;
  static constexpr int kSide = 15;
  static constexpr int kRow = 16;
  static constexpr int kSlab = kSide * kRow;

  alignas(64) std::array<float, std::size_t{kSide} * kSlab> values{};  ///< [units]
  /// Bit n of row x * kSide + y: voxel kFirst + n along z is in the band; of others only the sign
  /// counts.
  std::array<std::uint16_t, std::size_t{kSide} * kSide> known{};
};

/// Coefficients of the cubic B-spline that stays closest to the grid's values f. With D the sum of
/// the second differences d2 along the axes and d4 that of the fourth, per axis and in voxels,
///   c = f - D/6 + D(D)/72 + 11/720 d4
/// which is the inverse of the spline's own smoothing, 1 + d2/6 along each axis, to the fourth
/// order, and 1/720 d4 more: interpolation is off by -t^2 (1 - t)^2 f''''/24 between voxels,
/// -f''''/720 in the mean, and that takes the mean away. Where the band does not hold D's own
/// neighbors, c = f - D/6 serves; where not even those, the cell is not known, and c is f, within
/// `plateau`. A voxel outside the band counts `plateau` [units], with its sign.
void fillCubic(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

/// The values themselves, for trilinear interpolation.
void fillLinear(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

}  // namespace palpate::vdb
