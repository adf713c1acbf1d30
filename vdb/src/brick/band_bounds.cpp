#include "brick/band_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "brick/cell_controls.h"

namespace palpate::vdb {
namespace {

using Voxel = BandBounds::Voxel;

using cells::Controls;
using cells::controlsOfThread;
using cells::kCells;
using cells::kRows;
using cells::Range;

/// [voxels] A cell whose coefficients all have the same sign and are larger than this needs no
/// closer look.
constexpr float kClear = 2.5F;
/// Bound of the error that rounding to floats leaves in a slope: some six roundings of values up to
/// 20 voxels, each counted three times.
constexpr double kRounding = 5e-5;

/// Least |slope along a direction|, from the ranges of three components: the direction is the
/// middle of the ranges.
double leastSlope(const std::array<Range, 3>& d) noexcept {
  double middle[3];
  double square = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    middle[a] = 0.5 * (static_cast<double>(d[a].lo) + static_cast<double>(d[a].hi));
    square += middle[a] * middle[a];
  }
  if (!(square > 0.0)) return 0.0;
  double least = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    least += std::min(middle[a] * static_cast<double>(d[a].lo),
                      middle[a] * static_cast<double>(d[a].hi));
  }
  return least / std::sqrt(square);
}

/// Whether some cell may be nearer to the surface than kClear, so that the brick needs a closer
/// look.
bool isNear(const Brick& brick) noexcept {
  float least = std::numeric_limits<float>::infinity();
  bool has_negative = false;
  bool has_positive = false;
  for (std::size_t x = 0; x < kRows; ++x) {
    for (std::size_t y = 0; y < kRows; ++y) {
      const float* const row = brick.values + (x * Brick::kSlab + y * Brick::kRow);
      for (std::size_t z = 0; z < kRows; ++z) {
        least = std::min(least, std::fabs(row[z]));
        has_negative |= row[z] < 0.0F;
        has_positive |= !(row[z] < 0.0F);
      }
    }
  }
  return least < kClear || (has_negative && has_positive);
}

template <std::size_t kSide>
void addCell(const float (&c)[kSide][kSide][kSide], bool known, bool is_steep, const Voxel& at,
             BandBounds& bounds) noexcept {
  const Range range = cells::rangeOf(c);
  // Only cells that answer count here: the path from the surface ends at the cell that does not.
  if (known && is_steep && range.least() < BandBounds::kNear) {
    bounds.steepest_near = std::max(bounds.steepest_near, cells::steepest(cells::slopesOf(c)));
  }
  if (!known) {
    if (range.least() < bounds.least_unknown) {
      bounds.least_unknown = range.least();
      bounds.unknown_at = at;
    }
    return;
  }
  if (range.least() > 0.0) return;
  ++bounds.surface_cells;
  const double slope = leastSlope(cells::slopesOf(c));
  if (slope < kSmoothSlope) ++bounds.rough_cells;
  if (slope < bounds.least_slope) {
    bounds.least_slope = slope;
    bounds.slope_at = at;
  }
}

}  // namespace

void BandBounds::add(const BandBounds& other) noexcept {
  // If equal, take the first along the axes, so that the result does not depend on the order of
  // threads.
  if (other.least_unknown < least_unknown ||
      (other.least_unknown == least_unknown && other.unknown_at < unknown_at)) {
    least_unknown = other.least_unknown;
    unknown_at = other.unknown_at;
  }
  if (other.least_slope < least_slope ||
      (other.least_slope == least_slope && other.slope_at < slope_at)) {
    least_slope = other.least_slope;
    slope_at = other.slope_at;
  }
  steepest_near = std::max(steepest_near, other.steepest_near);
  surface_cells += other.surface_cells;
  rough_cells += other.rough_cells;
}

double BandBounds::within() const noexcept {
  return std::max(least_way, std::min(least_unknown, kNear) / steepest_near);
}

double steepestInCells(const Brick& brick) noexcept {
  Controls& controls = controlsOfThread();
  controls.take(brick);
  double most = 0.0;
  for (std::size_t i = 0; i < kCells; ++i) {
    for (std::size_t j = 0; j < kCells; ++j) {
      for (std::size_t k = 0; k < kCells; ++k) {
        float c[4][4][4];
        controls.of(i, j, k, c);
        most = std::max(most, cells::steepest(cells::slopesOf(c)));
      }
    }
  }
  return most + kRounding;
}

void BandBounds::add(const Brick& brick, const Voxel& first, bool cubic,
                     double steepest_of_brick) noexcept {
  BandBounds own;
  const bool is_steep = steepest_of_brick > kNotSteep;
  if (!is_steep) own.steepest_near = std::max(1.0, steepest_of_brick);
  if (!isNear(brick)) {
    // All coefficients are on one side, at least kClear from 0; so is every value.
    own.least_unknown = kClear;
    own.unknown_at = first;
    const bool all_known = std::all_of(std::begin(brick.known), std::end(brick.known),
                                       [](std::uint8_t row) { return row == 0xFF; });
    if (!all_known) add(own);
    return;
  }
  Controls& controls = controlsOfThread();
  bool has_controls = false;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      for (int k = 0; k < kCells; ++k) {
        const bool known = cells::isKnown(brick, i, j, k);
        const Voxel at{first[0] + i, first[1] + j, first[2] + k};
        if (!cubic) {
          const float* const v = brick.values;
          const float corners[2][2][2] = {
              {{v[Brick::at(i, j, k)], v[Brick::at(i, j, k + 1)]},
               {v[Brick::at(i, j + 1, k)], v[Brick::at(i, j + 1, k + 1)]}},
              {{v[Brick::at(i + 1, j, k)], v[Brick::at(i + 1, j, k + 1)]},
               {v[Brick::at(i + 1, j + 1, k)], v[Brick::at(i + 1, j + 1, k + 1)]}}};
          addCell(corners, known, is_steep, at, own);
          continue;
        }
        const double least = cells::coefficientRange<4>(brick, i, j, k).least();
        const double clear = known ? (is_steep ? kNear : 0.0) : static_cast<double>(kClear);
        if (known ? least > clear : least >= clear) {
          if (!known && static_cast<double>(kClear) < own.least_unknown) {
            own.least_unknown = kClear;
            own.unknown_at = at;
          }
          continue;
        }
        if (!has_controls) controls.take(brick);
        has_controls = true;
        float c[4][4][4];
        controls.of(static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                    static_cast<std::size_t>(k), c);
        addCell(c, known, is_steep, at, own);
      }
    }
  }
  add(own);
}

}  // namespace palpate::vdb
