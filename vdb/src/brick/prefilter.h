#pragma once
/// From the grid's values to the contents of one brick.

#include <array>
#include <cstdint>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// The voxels that one brick's coefficients depend on: from -3 to 11 of its block along each axis.
struct Neighborhood {
  static constexpr int kFirst = -3;
  static constexpr int kSide = 15;
  static constexpr std::size_t kStep[3] = {kSide * kSide, kSide, 1};

  std::array<float, kSide * kSide * kSide> values;  ///< [units]
  std::array<std::uint8_t, kSide * kSide * kSide>
      known;  ///< 1: in the band; 0: only the sign counts

  [[nodiscard]] static constexpr std::size_t at(int x, int y, int z) noexcept {
    return static_cast<std::size_t>(x - kFirst) * kStep[0] +
           static_cast<std::size_t>(y - kFirst) * kStep[1] + static_cast<std::size_t>(z - kFirst);
  }
};

/// Coefficients of the cubic B-spline that stays closest to the grid's values f. With D the sum of the
/// second differences d2 along the axes and d4 that of the fourth, per axis and in voxels,
///   c = f - D/6 + D(D)/72 + 11/720 d4
/// which is the inverse of the spline's own smoothing, 1 + d2/6 along each axis, to the fourth order,
/// and 1/720 d4 more: interpolation is off by -t^2 (1 - t)^2 f''''/24 between voxels, -f''''/720 in the
/// mean, and that takes the mean away. Where the band does not hold D's own neighbors, c = f - D/6
/// serves; where not even those, the cell is not known, and c is f, within `plateau`. A voxel out of
/// the band counts `plateau` [units], with its sign.
void fillCubic(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

/// The values themselves, for trilinear interpolation.
void fillLinear(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick);

}  // namespace palpate::vdb
