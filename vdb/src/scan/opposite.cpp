#include "scan/opposite.h"

#include <algorithm>
#include <cstdlib>

namespace palpate::vdb {
namespace {

constexpr int kWide = Opposite::kSide + 2 * Opposite::kReach;
constexpr int kWindow = 2 * Opposite::kReach + 1;

/// For eight voxels side by side: the smallest squared distance so far [steps^2], and the squared
/// distance to the same voxel [voxels^2].
struct Row {
  alignas(32) float square[8];
  alignas(32) float voxels[8];
};

/// kCubic: both are the same, so that only `square` is computed.
template <bool kCubic>
inline void takeLess(Row& best, const Row& other, float square, float voxels) noexcept {
  for (int n = 0; n < 8; ++n) {
    if constexpr (kCubic) {
      best.square[n] = std::min(best.square[n], other.square[n] + square);
      continue;
    }
    const float s = other.square[n] + square;
    const float v = other.voxels[n] + voxels;
    const bool less = s < best.square[n] || (s == best.square[n] && v < best.voxels[n]);
    best.square[n] = less ? s : best.square[n];
    best.voxels[n] = less ? v : best.voxels[n];
  }
}

}  // namespace

Opposite::Opposite(const Vec3& spacing)
    : is_cubic_(spacing == Vec3(1.0)), nearest_(std::size_t{1} << kWindow, 255) {
  for (int a = 0; a < 3; ++a) {
    for (int n = 0; n <= kReach; ++n) {
      const double length = n * spacing[a];
      squares_[static_cast<std::size_t>(a)][static_cast<std::size_t>(n)] =
          static_cast<float>(length * length);
    }
  }
  for (std::size_t bits = 1; bits < nearest_.size(); ++bits) {
    for (int n = 0; n < kWindow; ++n) {
      if ((bits >> n & 1U) == 0) continue;
      nearest_[bits] = std::min(nearest_[bits], static_cast<std::uint8_t>(std::abs(n - kReach)));
    }
  }
}

bool Opposite::find(const Mask& mask, const std::array<int, 3>& first,
                    Found& found) const noexcept {
  return is_cubic_ ? findIn<true>(mask, first, found) : findIn<false>(mask, first, found);
}

template <bool kCubic>
bool Opposite::findIn(const Mask& mask, const std::array<int, 3>& first,
                      Found& found) const noexcept {
  // Bit n of a row: voxel first[0] - kReach + n is on that side.
  std::uint32_t rows[2][kWide][kWide];
  std::uint32_t any[2] = {0, 0};
  const int x0 = first[0] - kReach;
  const int from = std::max(0, -x0);
  const int to = std::min(kWide, mask.box[0] - x0);
  for (int z = 0; z < kWide; ++z) {
    for (int y = 0; y < kWide; ++y) {
      const int k = first[2] - kReach + z;
      const int j = first[1] - kReach + y;
      std::uint32_t inside = 0;
      std::uint32_t known = 0;
      if (k >= 0 && j >= 0 && k < mask.box[2] && j < mask.box[1] && from < to) {
        const std::uint8_t* const row = mask.inside.data() + mask.at(x0, j, k);
        for (int n = from; n < to; ++n) inside |= static_cast<std::uint32_t>(row[n]) << n;
        known = (1U << to) - (1U << from);
      }
      rows[0][z][y] = known & ~inside;
      rows[1][z][y] = inside;
      any[0] |= rows[0][z][y];
      any[1] |= rows[1][z][y];
    }
  }
  if (any[0] == 0 || any[1] == 0) return false;
  // Distance to the nearest voxel of each side, along x, then y, then z.
  Row along_x[kWide][kWide];
  Row along_y[kWide][kSide];
  for (std::size_t side = 0; side < 2; ++side) {
    for (int z = 0; z < kWide; ++z) {
      for (int y = 0; y < kWide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const std::uint32_t bits = rows[side][z][y] >> x & ((1U << kWindow) - 1U);
          const std::uint8_t n = nearest_[bits];
          along_x[z][y].square[x] = n == 255 ? kNone : squares_[0][n];
          along_x[z][y].voxels[x] = n == 255 ? kNone : static_cast<float>(n * n);
        }
      }
      for (int y = 0; y < kSide; ++y) {
        Row& best = along_y[z][y];
        best = along_x[z][y + kReach];
        for (int d = -kReach; d <= kReach; ++d) {
          const auto n = static_cast<std::size_t>(std::abs(d));
          if (d != 0)
            takeLess<kCubic>(best, along_x[z][y + kReach + d], squares_[1][n],
                             static_cast<float>(d * d));
        }
      }
    }
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        Row best = along_y[z + kReach][y];
        for (int d = -kReach; d <= kReach; ++d) {
          const auto n = static_cast<std::size_t>(std::abs(d));
          if (d != 0)
            takeLess<kCubic>(best, along_y[z + kReach + d][y], squares_[2][n],
                             static_cast<float>(d * d));
        }
        // Distances count for voxels on the other side only: those of this side have distance 0.
        const std::uint32_t other = rows[1 - side][z + kReach][y + kReach] >> kReach;
        for (int x = 0; x < kSide; ++x) {
          const int n = (z * kSide + y) * kSide + x;
          const auto place = static_cast<std::size_t>(n);
          const bool is_other = (other >> x & 1U) != 0;
          if (is_other || side == 0) {
            found.square[place] = is_other ? best.square[x] : kNone;
            found.voxels[place] = is_other ? (kCubic ? best.square[x] : best.voxels[x]) : kNone;
          }
        }
      }
    }
  }
  return true;
}

}  // namespace palpate::vdb
