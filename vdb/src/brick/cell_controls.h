#pragma once
/// The control values of a brick's cells, which bound the spline: see BandBounds.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "brick/brick_view.h"

namespace palpate::vdb::cells {

inline constexpr int kCells = Brick::kSide;
inline constexpr std::size_t kRows = Brick::kRows;
inline constexpr std::size_t kFine = 3 * kCells + 1;  ///< control values along an axis
inline constexpr std::size_t kFineRow =
    kFine + 3;  ///< floats, so that four can be read from the last one on

/// The control values of the cells along one axis, computed from 11 coefficients. `from(i)` reads
/// coefficient i; `to(i, value)` stores control value i.
template <typename From, typename To>
void refine(const From& from, const To& to) noexcept {
  for (std::size_t i = 0; i <= kCells; ++i) {
    to(3 * i, (from(i) + 4.0F * from(i + 1) + from(i + 2)) / 6.0F);
    if (i == kCells) break;
    to(3 * i + 1, (2.0F * from(i + 1) + from(i + 2)) / 3.0F);
    to(3 * i + 2, (from(i + 1) + 2.0F * from(i + 2)) / 3.0F);
  }
}

/// The smallest and the largest of some numbers.
struct Range {
  float lo = std::numeric_limits<float>::infinity();
  float hi = -std::numeric_limits<float>::infinity();

  void include(float value) noexcept {
    lo = std::min(lo, value);
    hi = std::max(hi, value);
  }
  /// Least absolute value; 0 if both signs occur.
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

  /// Copies the control values of one cell.
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

/// One object for each thread, because it is too large for the stack of some threads.
inline Controls& controlsOfThread() noexcept {
  thread_local Controls controls;
  return controls;
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

/// Ranges of the three derivatives: differences of neighbors, times the polynomial's degree.
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

/// Range of the cell's coefficients: `kSide` along each axis.
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

inline bool isKnown(const Brick& brick, int i, int j, int k) noexcept {
  return (brick.known[i * kCells + j] >> k & 1U) != 0;
}

/// [-] Upper bound of the slope.
inline double steepest(const std::array<Range, 3>& d) noexcept {
  double square = 0.0;
  for (const Range& range : d) {
    const double most = std::max(-static_cast<double>(range.lo), static_cast<double>(range.hi));
    square += most * most;
  }
  return std::sqrt(square);
}

}  // namespace palpate::vdb::cells
