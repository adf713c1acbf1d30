#include "brick/slopes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr std::size_t kCount = sizeof(Brick::values) / sizeof(float);
constexpr std::array<std::size_t, 3> kStrides{Brick::kSlab, Brick::kRow, 1};
using Numbers = std::array<float, kCount>;

/// Each number becomes the largest of `width` numbers from it on. Runs over the ends of rows; what
/// comes of that is not looked at.
void slideMaximum(Numbers& numbers, std::size_t stride, std::size_t width) noexcept {
  for (std::size_t n = 0; n + (width - 1) * stride < kCount; ++n) {
    float most = numbers[n];
    for (std::size_t k = 1; k < width; ++k) most = std::max(most, numbers[n + k * stride]);
    numbers[n] = most;
  }
}

/// Each component of the gradient is a mean of the differences between neighbors along its axis, of
/// the voxels from `first` to `last` from the cell's own.
double steepestSquare(const Brick& brick, int first, int last) noexcept {
  const auto steps = static_cast<std::size_t>(last - first);
  std::array<Numbers, 3> slopes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Numbers& slope = slopes[axis];
    for (std::size_t n = 0; n + kStrides[axis] < kCount; ++n) {
      slope[n] = std::fabs(brick.values[n + kStrides[axis]] - brick.values[n]);
    }
    for (std::size_t other = 0; other < 3; ++other) {
      slideMaximum(slope, kStrides[other], other == axis ? steps : steps + 1);
    }
  }
  float most = 0.0F;
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      for (int z = 0; z < Brick::kSide; ++z) {
        const std::size_t at = Brick::at(x + first, y + first, z + first);
        most = std::max(most, slopes[0][at] * slopes[0][at] + slopes[1][at] * slopes[1][at] +
                                  slopes[2][at] * slopes[2][at]);
      }
    }
  }
  return most;
}

}  // namespace

double steepestSquareCubic(const Brick& brick) noexcept { return steepestSquare(brick, -1, 2); }
double steepestSquareLinear(const Brick& brick) noexcept { return steepestSquare(brick, 0, 1); }

}  // namespace palpate::vdb
