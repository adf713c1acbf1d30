#include "brick/prefilter.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr int kSide = Neighborhood::kSide;
constexpr int kCount = kSide * kSide * kSide;
constexpr int kStepX = kSide * kSide;
constexpr int kStepY = kSide;

/// Rows of a brick, in the neighborhood: its voxels -1 to 9.
constexpr int kFirstRow = -1 - Neighborhood::kFirst;

float clipped(float value, bool known, float plateau) {
  return known ? std::clamp(value, -plateau, plateau) : std::copysign(plateau, value);
}

/// Second differences along the axes, and their sum, of the voxels that have neighbors.
struct Differences {
  std::array<double, kCount> along_x, along_y, along_z, sum;
};

void difference(const Neighborhood& from, Differences& d) {
  const auto& f = from.values;
  for (int x = 1; x + 1 < kSide; ++x) {
    for (int y = 1; y + 1 < kSide; ++y) {
      const int row = x * kStepX + y * kStepY;
      for (int n = row + 1; n < row + kSide - 1; ++n) {
        const auto i = static_cast<std::size_t>(n);
        const double twice = 2.0 * static_cast<double>(f[i]);
        d.along_x[i] = static_cast<double>(f[i - kStepX]) + f[i + kStepX] - twice;
        d.along_y[i] = static_cast<double>(f[i - kStepY]) + f[i + kStepY] - twice;
        d.along_z[i] = static_cast<double>(f[i - 1]) + f[i + 1] - twice;
        d.sum[i] = d.along_x[i] + d.along_y[i] + d.along_z[i];
      }
    }
  }
}

/// Whether voxel i and all that D, or D(D), of it depends on is in the band.
struct Reach {
  bool near, far;
};

Reach reachOf(const std::array<std::uint8_t, kCount>& known, std::size_t i) {
  constexpr std::size_t kX = kStepX;
  constexpr std::size_t kY = kStepY;
  const unsigned near = known[i] & known[i - kX] & known[i + kX] & known[i - kY] & known[i + kY] &
                        known[i - 1] & known[i + 1];
  if (near == 0) return {false, false};
  const unsigned far = known[i - 2 * kX] & known[i + 2 * kX] & known[i - 2 * kY] &
                       known[i + 2 * kY] & known[i - 2] & known[i + 2] & known[i - kX - kY] &
                       known[i - kX + kY] & known[i + kX - kY] & known[i + kX + kY] &
                       known[i - kX - 1] & known[i - kX + 1] & known[i + kX - 1] &
                       known[i + kX + 1] & known[i - kY - 1] & known[i - kY + 1] &
                       known[i + kY - 1] & known[i + kY + 1];
  return {true, far != 0};
}

/// Rows of flags along z, one bit a voxel: bit n is voxel n - 1.
using Flags = std::array<std::array<unsigned, Brick::kRows>, Brick::kRows>;

/// A cell is known if all its voxels are: from `first` to `last` from its own, along each axis.
void markCells(const Flags& flags, int first, int last, Brick& brick) {
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      unsigned rows = ~0U;
      for (int i = first; i <= last; ++i) {
        for (int j = first; j <= last; ++j) {
          rows &= flags[static_cast<std::size_t>(x + i + 1)][static_cast<std::size_t>(y + j + 1)];
        }
      }
      unsigned cells = ~0U;
      for (int k = first; k <= last; ++k) cells &= rows >> (k + 1);
      brick.known[x * Brick::kSide + y] = static_cast<std::uint8_t>(cells & 0xFFU);
    }
  }
}

}  // namespace

void fillCubic(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick) {
  Differences d;
  difference(from, d);
  const double scale = 1.0 / units_per_voxel;
  Flags flags{};
  for (int x = 0; x < Brick::kRows; ++x) {
    for (int y = 0; y < Brick::kRows; ++y) {
      const int row = (x + kFirstRow) * kStepX + (y + kFirstRow) * kStepY + kFirstRow;
      float* const out = brick.values + (x * Brick::kSlab + y * Brick::kRow);
      unsigned bits = 0;
      for (int z = 0; z < Brick::kRows; ++z) {
        const auto i = static_cast<std::size_t>(row + z);
        const Reach reach = reachOf(from.known, i);
        double c = clipped(from.values[i], from.known[i] != 0, plateau);
        if (reach.near) c = static_cast<double>(from.values[i]) - d.sum[i] / 6.0;
        if (reach.far) {
          const double sum = 2.0 * d.sum[i];
          const double x2 = -2.0 * d.along_x[i] + d.along_x[i - kStepX] + d.along_x[i + kStepX];
          const double y2 = -2.0 * d.along_y[i] + d.along_y[i - kStepY] + d.along_y[i + kStepY];
          const double z2 = -2.0 * d.along_z[i] + d.along_z[i - 1] + d.along_z[i + 1];
          const double twice = d.sum[i - kStepX] + d.sum[i + kStepX] + d.sum[i - kStepY] +
                               d.sum[i + kStepY] + d.sum[i - 1] + d.sum[i + 1] - 3.0 * sum;
          c += twice / 72.0 + 11.0 / 720.0 * (x2 + y2 + z2);
        }
        bits |= (reach.near ? 1U : 0U) << z;
        out[z] = static_cast<float>(c * scale);
      }
      out[Brick::kRows] = 0.0F;
      flags[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] = bits;
    }
  }
  markCells(flags, -1, 2, brick);
}

void fillLinear(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick) {
  const double scale = 1.0 / units_per_voxel;
  Flags flags{};
  for (int x = 0; x < Brick::kRows; ++x) {
    for (int y = 0; y < Brick::kRows; ++y) {
      const int row = (x + kFirstRow) * kStepX + (y + kFirstRow) * kStepY + kFirstRow;
      float* const out = brick.values + (x * Brick::kSlab + y * Brick::kRow);
      unsigned bits = 0;
      for (int z = 0; z < Brick::kRows; ++z) {
        const auto i = static_cast<std::size_t>(row + z);
        const bool known = from.known[i] != 0;
        const float value = known ? from.values[i] : std::copysign(plateau, from.values[i]);
        out[z] = static_cast<float>(value * scale);
        bits |= (known ? 1U : 0U) << z;
      }
      out[Brick::kRows] = 0.0F;
      flags[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] = bits;
    }
  }
  markCells(flags, 0, 1, brick);
}

}  // namespace palpate::vdb
