#include "scan/opposite.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace palpate::vdb {
namespace {

/// For eight voxels side by side: the smallest squared distance so far [steps^2], the squared
/// distance to the same voxel [voxels^2], and the smallest of those to any.
struct Row {
  alignas(32) float square[8];
  alignas(32) float voxels[8];
  alignas(32) float fewest[8];
};

/// kCubic: all are the same, so that only `square` is computed.
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
    best.fewest[n] = std::min(best.fewest[n], other.fewest[n] + voxels);
  }
}

/// Steps from bit `at` to the nearest set bit, at most `reach` away; -1: none is set there.
int nearestBit(std::uint64_t bits, int at, int reach) noexcept {
  constexpr int kFar = 64;
  const std::uint64_t above = bits >> at;
  const std::uint64_t below = bits << (63 - at);
  const int up = above == 0 ? kFar : __builtin_ctzll(above);
  const int down = below == 0 ? kFar : __builtin_clzll(below);
  const int nearest = std::min(up, down);
  return nearest <= reach ? nearest : -1;
}

}  // namespace

Opposite::Opposite(const Vec3& spacing) : is_cubic_(spacing == Vec3(1.0)), seen_(kInfinity) {
  const double farthest = kReach * std::max({spacing.x, spacing.y, spacing.z});
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    reach_[axis] = std::min(static_cast<int>(std::ceil(farthest / spacing[a] - 1e-6)), kMostReach);
    seen_ = std::min(seen_, (reach_[axis] + 1) * spacing[a]);
    for (int n = 0; n <= kMostReach; ++n) {
      const double length = n * spacing[a];
      squares_[axis][static_cast<std::size_t>(n)] = static_cast<float>(length * length);
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
  constexpr int kWide = kSide + 2 * (kCubic ? kReach : kMostReach);
  static_assert(kWide <= 64, "a row of voxels has to fit into a word");
  const int rx = kCubic ? kReach : reach_[0];
  const int ry = kCubic ? kReach : reach_[1];
  const int rz = kCubic ? kReach : reach_[2];
  // Bit n of a row: voxel first[0] - rx + n is on that side.
  std::uint64_t rows[2][kWide][kWide];
  std::uint64_t any[2] = {0, 0};
  const int x0 = first[0] - rx;
  const int from = std::max(0, -x0);
  const int to = std::min(kSide + 2 * rx, mask.box[0] - x0);
  for (int z = 0; z < kSide + 2 * rz; ++z) {
    for (int y = 0; y < kSide + 2 * ry; ++y) {
      const int k = first[2] - rz + z;
      const int j = first[1] - ry + y;
      std::uint64_t inside = 0;
      std::uint64_t known = 0;
      if (k >= 0 && j >= 0 && k < mask.box[2] && j < mask.box[1] && from < to) {
        const std::uint8_t* const row = mask.inside.data() + mask.at(x0, j, k);
        for (int n = from; n < to; ++n) inside |= static_cast<std::uint64_t>(row[n]) << n;
        known = (std::uint64_t{1} << to) - (std::uint64_t{1} << from);
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
    for (int z = 0; z < kSide + 2 * rz; ++z) {
      for (int y = 0; y < kSide + 2 * ry; ++y) {
        Row& row = along_x[z][y];
        for (int x = 0; x < kSide; ++x) {
          const int n = nearestBit(rows[side][z][y], x + rx, rx);
          row.square[x] = n < 0 ? kNone : squares_[0][static_cast<std::size_t>(n)];
          row.voxels[x] = row.fewest[x] = n < 0 ? kNone : static_cast<float>(n * n);
        }
      }
      for (int y = 0; y < kSide; ++y) {
        Row& best = along_y[z][y];
        best = along_x[z][y + ry];
        for (int d = -ry; d <= ry; ++d) {
          const auto n = static_cast<std::size_t>(std::abs(d));
          if (d != 0)
            takeLess<kCubic>(best, along_x[z][y + ry + d], squares_[1][n],
                             static_cast<float>(d * d));
        }
      }
    }
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; ++y) {
        Row best = along_y[z + rz][y];
        for (int d = -rz; d <= rz; ++d) {
          const auto n = static_cast<std::size_t>(std::abs(d));
          if (d != 0)
            takeLess<kCubic>(best, along_y[z + rz + d][y], squares_[2][n],
                             static_cast<float>(d * d));
        }
        // Distances count for voxels on the other side only: those of this side have distance 0.
        const std::uint64_t other = rows[1 - side][z + rz][y + ry] >> rx;
        for (int x = 0; x < kSide; ++x) {
          const int n = (z * kSide + y) * kSide + x;
          const auto place = static_cast<std::size_t>(n);
          const bool is_other = (other >> x & 1U) != 0;
          if (is_other || side == 0) {
            found.square[place] = is_other ? best.square[x] : kNone;
            found.voxels[place] = is_other ? (kCubic ? best.square[x] : best.voxels[x]) : kNone;
            found.fewest[place] = is_other ? (kCubic ? best.square[x] : best.fewest[x]) : kNone;
          }
        }
      }
    }
  }
  return true;
}

}  // namespace palpate::vdb
