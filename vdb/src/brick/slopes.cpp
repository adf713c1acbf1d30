#include "brick/slopes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr std::size_t kCount = sizeof(Brick::values) / sizeof(float);
/// Loops run over the ends of rows, and of the brick by as much as the widest window; what comes of
/// that is not looked at.
constexpr std::size_t kBehind = 4 * Brick::kSlab;
using Numbers = std::array<float, kCount + kBehind>;

float larger(float a, float b) noexcept { return a < b ? b : a; }

/// Each number becomes the larger of it and the one `kStep` on.
template <std::size_t kStep>
void pairMaximum(Numbers& numbers) noexcept {
  for (std::size_t n = 0; n < kCount; ++n) numbers[n] = larger(numbers[n], numbers[n + kStep]);
}

/// Each number becomes the largest of `kWidth` numbers from it on, 1 to 4.
template <std::size_t kStride, std::size_t kWidth>
void slideMaximum(Numbers& numbers) noexcept {
  if constexpr (kWidth > 1) pairMaximum<kStride>(numbers);
  if constexpr (kWidth > 2) pairMaximum<kStride*(kWidth - 2)>(numbers);
}

/// The steepest of `kSteps` differences along the axis with `kStride`, of kSteps + 1 rows across it.
template <std::size_t kStride, std::size_t kSteps>
void slopesAlong(const Brick& brick, Numbers& slope) noexcept {
  for (std::size_t n = 0; n < kCount - kStride; ++n) {
    slope[n] = std::fabs(brick.values[n + kStride] - brick.values[n]);
  }
  std::fill(slope.begin() + static_cast<std::ptrdiff_t>(kCount - kStride), slope.end(), 0.0F);
  constexpr auto width = [](std::size_t stride) { return stride == kStride ? kSteps : kSteps + 1; };
  slideMaximum<Brick::kSlab, width(Brick::kSlab)>(slope);
  slideMaximum<Brick::kRow, width(Brick::kRow)>(slope);
  slideMaximum<1, width(1)>(slope);
}

/// Each component of the gradient is a mean of the differences between neighbors along its axis, of
/// the voxels from `kFirst` to `kLast` from the cell's own.
template <int kFirst, int kLast>
double steepestSquare(const Brick& brick) noexcept {
  constexpr auto kSteps = static_cast<std::size_t>(kLast - kFirst);
  Numbers by_x, by_y, by_z;
  slopesAlong<Brick::kSlab, kSteps>(brick, by_x);
  slopesAlong<Brick::kRow, kSteps>(brick, by_y);
  slopesAlong<1, kSteps>(brick, by_z);
  std::array<float, Brick::kSide> most{};
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      const std::size_t at = Brick::at(x + kFirst, y + kFirst, kFirst);
      for (std::size_t z = 0; z < Brick::kSide; ++z) {
        const std::size_t n = at + z;
        most[z] = larger(most[z], by_x[n] * by_x[n] + by_y[n] * by_y[n] + by_z[n] * by_z[n]);
      }
    }
  }
  return *std::max_element(most.begin(), most.end());
}

}  // namespace

double steepestSquareCubic(const Brick& brick) noexcept { return steepestSquare<-1, 2>(brick); }
double steepestSquareLinear(const Brick& brick) noexcept { return steepestSquare<0, 1>(brick); }

}  // namespace palpate::vdb
