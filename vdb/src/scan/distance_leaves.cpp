#include "scan/distance_leaves.h"

#include <algorithm>
#include <cmath>

#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

std::uint64_t keyOf(const Coord& voxel) noexcept {
  const auto part = [](int x) {
    const int leaf = (x >> 3) + (1 << 20);
    return static_cast<std::uint64_t>(leaf);
  };
  return part(voxel.x()) << 42 | part(voxel.y()) << 21 | part(voxel.z());
}

Coord originOf(std::uint64_t key) noexcept {
  const auto part = [&](int shift) {
    return (static_cast<int>(key >> shift & 0x1FFFFFU) - (1 << 20)) * 8;
  };
  return {part(42), part(21), part(0)};
}

void unite(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

std::vector<std::uint64_t> keysAround(const std::vector<Vec3>& points, double reach) {
  const auto down = [](double x) { return static_cast<int>(std::floor(x)) & ~7; };
  constexpr std::size_t kMostDoubles = 4'000'000;
  std::vector<std::uint64_t> keys;
  std::uint64_t last = 0;
  // Points come lattice voxel by lattice voxel: most ask for the same leaves as the one before.
  for (const Vec3& p : points) {
    const Coord lo(down(p.x - reach), down(p.y - reach), down(p.z - reach));
    const Coord hi(down(p.x + reach), down(p.y + reach), down(p.z + reach));
    const std::uint64_t same = keyOf(lo) ^ (keyOf(hi) * 0x9E3779B97F4A7C15U);
    if (same == last) continue;
    last = same;
    for (int x = lo.x(); x <= hi.x(); x += 8) {
      for (int y = lo.y(); y <= hi.y(); y += 8) {
        for (int z = lo.z(); z <= hi.z(); z += 8) keys.push_back(keyOf({x, y, z}));
      }
    }
    if (keys.size() > kMostDoubles) unite(keys);
  }
  unite(keys);
  return keys;
}

}  // namespace

DistanceLeaves::DistanceLeaves(const std::vector<Vec3>& points, double reach)
    : keys_(keysAround(points, reach)), leaves_(keys_.size()) {
  forBlocks(leaves_.size(), [&](std::size_t n) {
    DistanceLeaf& leaf = leaves_[n];
    leaf.origin = originOf(keys_[n]);
    leaf.distance.fill(DistanceLeaf::kNowhere);
    leaf.feet.clear();
    for (int side = 0; side < 27; ++side) {
      leaf.near[static_cast<std::size_t>(side)] = indexAt(
          leaf.origin.offsetBy(8 * (side / 9 - 1), 8 * (side / 3 % 3 - 1), 8 * (side % 3 - 1)));
    }
  });
}

std::int32_t DistanceLeaves::indexAt(const Coord& voxel) const noexcept {
  const std::uint64_t key = keyOf(voxel);
  const auto at = std::lower_bound(keys_.begin(), keys_.end(), key);
  if (at == keys_.end() || *at != key) return -1;
  return static_cast<std::int32_t>(at - keys_.begin());
}

VoxelBits DistanceLeaves::besideKnown(const DistanceLeaf& leaf) const noexcept {
  // Rows of ten bits (z from -1 to 8), in slabs of ten rows.
  std::array<std::array<std::uint32_t, 10>, 10> rows{};
  // The first row and slab are the last ones of the leaf before.
  const auto side = [](std::size_t n) -> std::size_t { return n == 0 ? 0 : n == 9 ? 2 : 1; };
  for (std::size_t x = 0; x < 10; ++x) {
    for (std::size_t y = 0; y < 10; ++y) {
      std::uint32_t row = 0;
      for (std::size_t z = 0; z < 3; ++z) {
        const std::int32_t n = leaf.near[9 * side(x) + 3 * side(y) + z];
        if (n < 0) continue;
        const VoxelBits& known = leaves_[static_cast<std::size_t>(n)].known;
        const auto eight =
            static_cast<std::uint32_t>(known[(x + 7) & 7U] >> (8 * ((y + 7) & 7U)) & 0xFFU);
        row |= z == 0 ? eight >> 7 : z == 1 ? eight << 1 : (eight & 1U) << 9;
      }
      row |= row << 1 | row >> 1;
      rows[x][y] = row;
    }
  }
  VoxelBits result{};
  for (std::size_t x = 0; x < 8; ++x) {
    for (std::size_t y = 0; y < 8; ++y) {
      std::uint32_t row = 0;
      for (std::size_t n = 0; n < 9; ++n) row |= rows[x + n / 3][y + n % 3];
      result[x] |= std::uint64_t{row >> 1 & 0xFFU} << (8 * y);
    }
  }
  return result;
}

std::array<const Feet*, 27> DistanceLeaves::feetAround(const DistanceLeaf& leaf) const noexcept {
  std::array<const Feet*, 27> feet{};
  for (std::size_t n = 0; n < 27; ++n) {
    if (leaf.near[n] >= 0) feet[n] = &leaves_[static_cast<std::size_t>(leaf.near[n])].feet;
  }
  return feet;
}

}  // namespace palpate::vdb
