#include "brick/slopes.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

/// Each component of the gradient is a mean of the differences between neighbors along its axis, of
/// the voxels from `first` to `last` from the cell's own.
double steepestSquare(const Brick& brick, int first, int last) noexcept {
  float most = 0.0F;
  const auto step = [&](int x, int y, int z, std::size_t stride) {
    const std::size_t at = Brick::at(x, y, z);
    return std::fabs(brick.values[at + stride] - brick.values[at]);
  };
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      for (int z = 0; z < Brick::kSide; ++z) {
        float dx = 0.0F, dy = 0.0F, dz = 0.0F;
        for (int i = x + first; i <= x + last; ++i) {
          for (int j = y + first; j <= y + last; ++j) {
            for (int k = z + first; k <= z + last; ++k) {
              if (i < x + last) dx = std::max(dx, step(i, j, k, Brick::kSlab));
              if (j < y + last) dy = std::max(dy, step(i, j, k, Brick::kRow));
              if (k < z + last) dz = std::max(dz, step(i, j, k, 1));
            }
          }
        }
        most = std::max(most, dx * dx + dy * dy + dz * dz);
      }
    }
  }
  return most;
}

}  // namespace

double steepestSquareCubic(const Brick& brick) noexcept { return steepestSquare(brick, -1, 2); }
double steepestSquareLinear(const Brick& brick) noexcept { return steepestSquare(brick, 0, 1); }

}  // namespace palpate::vdb
