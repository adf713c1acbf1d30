#include "brick/band_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::vdb {
namespace {

using Voxel = BandBounds::Voxel;

constexpr int kCells = Brick::kSide;
constexpr std::size_t kRows = Brick::kRows;
constexpr std::size_t kFine = 3 * kCells + 1;  ///< control values along an axis
constexpr std::size_t kFineRow = kFine + 3;    ///< floats, so that four can be read at the last
/// [voxels] A cell whose coefficients are all beyond that needs no closer look.
constexpr float kClear = 2.5F;
/// What rounding to floats leaves of a slope: some six roundings of values up to 20 voxels, three times each.
constexpr double kRounding = 5e-5;

/// The control values of the cells along one axis, out of 11 coefficients `step` apart; `to` likewise.
template <typename From, typename To>
void refine(const From& from, const To& to) noexcept {
  for (std::size_t i = 0; i <= kCells; ++i) {
    to(3 * i, (from(i) + 4.0F * from(i + 1) + from(i + 2)) / 6.0F);
    if (i == kCells) break;
    to(3 * i + 1, (2.0F * from(i + 1) + from(i + 2)) / 3.0F);
    to(3 * i + 2, (from(i + 1) + 2.0F * from(i + 2)) / 3.0F);
  }
}

/// The least and the largest of some numbers.
struct Range {
  float lo = std::numeric_limits<float>::infinity();
  float hi = -std::numeric_limits<float>::infinity();

  void include(float value) noexcept {
    lo = std::min(lo, value);
    hi = std::max(hi, value);
  }
  /// Of the absolute value; 0 if both signs occur.
  [[nodiscard]] double least() const noexcept {
    return std::max({0.0, static_cast<double>(lo), -static_cast<double>(hi)});
  }
};

/// Control values of a brick's cells.
class Controls {
 public:
  void take(const Brick& brick) noexcept {
    for (std::size_t y = 0; y < kRows; ++y) {
      for (std::size_t z = 0; z < kRows; ++z) {
        refine([&](std::size_t x) { return brick.values[x * Brick::kSlab + y * Brick::kRow + z]; },
               [&](std::size_t x, float value) { by_x_[x][y][z] = value; });
      }
    }
    for (std::size_t x = 0; x < kFine; ++x) {
      for (std::size_t z = 0; z < kRows; ++z) {
        refine([&](std::size_t y) { return by_x_[x][y][z]; },
               [&](std::size_t y, float value) { by_xy_[x][y][z] = value; });
      }
    }
  }

  /// Those of a cell.
  void of(std::size_t i, std::size_t j, std::size_t k, float (&to)[4][4][4]) const noexcept {
    for (std::size_t x = 0; x < 4; ++x) {
      for (std::size_t y = 0; y < 4; ++y) {
        const float* const c = &by_xy_[3 * i + x][3 * j + y][k];
        to[x][y][0] = (c[0] + 4.0F * c[1] + c[2]) / 6.0F;
        to[x][y][1] = (2.0F * c[1] + c[2]) / 3.0F;
        to[x][y][2] = (c[1] + 2.0F * c[2]) / 3.0F;
        to[x][y][3] = (c[1] + 4.0F * c[2] + c[3]) / 6.0F;
      }
    }
  }

 private:
  float by_x_[kFine][kRows][kRows];
  float by_xy_[kFine][kFine][kRows];
};

/// Too large for the stack of some threads.
Controls& controlsOfThread() noexcept {
  thread_local Controls controls;
  return controls;
}

/// Of |slope along a direction|, from the ranges of three components: the direction is their middle.
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

template <std::size_t kSide>
Range rangeOf(const float (&c)[kSide][kSide][kSide]) noexcept {
  Range range;
  for (const auto& slab : c) {
    for (const auto& row : slab) {
      for (const float value : row) range.include(value);
    }
  }
  return range;
}

/// Of the three derivatives: differences of neighbors, by the polynomial's degree.
template <std::size_t kSide>
std::array<Range, 3> slopesOf(const float (&c)[kSide][kSide][kSide]) noexcept {
  constexpr auto kDegree = static_cast<float>(kSide - 1);
  std::array<Range, 3> d;
  for (std::size_t x = 0; x < kSide; ++x) {
    for (std::size_t y = 0; y < kSide; ++y) {
      for (std::size_t z = 0; z < kSide; ++z) {
        if (x + 1 < kSide) d[0].include(kDegree * (c[x + 1][y][z] - c[x][y][z]));
        if (y + 1 < kSide) d[1].include(kDegree * (c[x][y + 1][z] - c[x][y][z]));
        if (z + 1 < kSide) d[2].include(kDegree * (c[x][y][z + 1] - c[x][y][z]));
      }
    }
  }
  return d;
}

/// The cell's coefficients: `kSide` along each axis.
template <std::size_t kSide>
Range coefficientRange(const Brick& brick, int i, int j, int k) noexcept {
  constexpr int kFirst = kSide == 4 ? -1 : 0;
  Range range;
  for (int x = 0; x < static_cast<int>(kSide); ++x) {
    for (int y = 0; y < static_cast<int>(kSide); ++y) {
      const float* const row = brick.values + Brick::at(i + x + kFirst, j + y + kFirst, k + kFirst);
      for (std::size_t z = 0; z < kSide; ++z) range.include(row[z]);
    }
  }
  return range;
}

bool isKnown(const Brick& brick, int i, int j, int k) noexcept {
  return (brick.known[i * kCells + j] >> k & 1U) != 0;
}

/// Whether some cell may be nearer to the surface than kClear, so that the brick is worth a closer look.
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

double steepest(const std::array<Range, 3>& d) noexcept {
  double square = 0.0;
  for (const Range& range : d) {
    const double most = std::max(-static_cast<double>(range.lo), static_cast<double>(range.hi));
    square += most * most;
  }
  return std::sqrt(square);
}

template <std::size_t kSide>
void addCell(const float (&c)[kSide][kSide][kSide], bool known, bool is_steep, const Voxel& at,
             BandBounds& bounds) noexcept {
  const Range range = rangeOf(c);
  if (is_steep && range.least() < BandBounds::kNear) {
    bounds.steepest_near = std::max(bounds.steepest_near, steepest(slopesOf(c)));
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
  const double slope = leastSlope(slopesOf(c));
  if (slope < kSmoothSlope) ++bounds.rough_cells;
  if (slope < bounds.least_slope) {
    bounds.least_slope = slope;
    bounds.slope_at = at;
  }
}

}  // namespace

void BandBounds::add(const BandBounds& other) noexcept {
  // Of equals the first along the axes, so that the order of threads does not tell.
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
  return std::min(least_unknown, kNear) / steepest_near;
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
        most = std::max(most, steepest(slopesOf(c)));
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
    // No coefficient is nearer to 0 than kClear, and none of another side: no value either.
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
        const bool known = isKnown(brick, i, j, k);
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
        const double least = coefficientRange<4>(brick, i, j, k).least();
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
