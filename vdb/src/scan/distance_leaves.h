#pragma once
/// Distances of a grid's voxels while they are computed, leaf by leaf.

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "huge_vector.h"
#include "palpate/core/math.h"
#include "scan/nearest_feet.h"

namespace palpate::vdb {

using VoxelBits = std::array<std::uint64_t, 8>;  ///< a word for each x, bit 8 y + z

inline void setBit(VoxelBits& bits, std::size_t place) noexcept {
  bits[place >> 6] |= std::uint64_t{1} << (place & 63U);
}
inline void clearBit(VoxelBits& bits, std::size_t place) noexcept {
  bits[place >> 6] &= ~(std::uint64_t{1} << (place & 63U));
}
[[nodiscard]] inline bool testBit(const VoxelBits& bits, std::size_t place) noexcept {
  return (bits[place >> 6] >> (place & 63U) & 1U) != 0;
}

/// The voxels of an OpenVDB leaf. Lengths are in voxels.
struct DistanceLeaf {
  static constexpr std::size_t kVoxels = 512;
  static constexpr float kNowhere = std::numeric_limits<float>::max();

  openvdb::Coord origin;
  std::array<std::int32_t, 27> near{};  ///< leaves around it, 9 dx + 3 dy + dz from -1 on; -1: none
  VoxelBits known{};  ///< voxels whose closest point their neighbors may start from
  VoxelBits inside{};
  Feet feet;                            ///< of the known voxels
  std::array<float, kVoxels> distance;  ///< kNowhere: not found

  /// [voxels]
  [[nodiscard]] Vec3 positionOf(std::size_t place) const noexcept {
    const auto n = static_cast<int>(place);
    return {origin.x() + (n >> 6), origin.y() + (n >> 3 & 7), origin.z() + (n & 7)};
  }
};

/// All leaves that have a voxel within `reach`, along each axis, of one of the points [voxels], in
/// a fixed order.
class DistanceLeaves {
 public:
  DistanceLeaves(const std::vector<Vec3>& points, double reach);

  [[nodiscard]] HugeVector<DistanceLeaf>& all() noexcept { return leaves_; }
  [[nodiscard]] const HugeVector<DistanceLeaf>& all() const noexcept { return leaves_; }

  /// The index of the leaf with that voxel, or -1.
  [[nodiscard]] std::int32_t indexAt(const openvdb::Coord& voxel) const noexcept;

  /// Voxels of a leaf next to known ones, across faces, edges or corners.
  [[nodiscard]] VoxelBits besideKnown(const DistanceLeaf& leaf) const noexcept;

  /// The feet of a leaf and of those around it.
  [[nodiscard]] std::array<const Feet*, 27> feetAround(const DistanceLeaf& leaf) const noexcept;

 private:
  std::vector<std::uint64_t> keys_;  ///< of the leaves' origins, ascending
  HugeVector<DistanceLeaf> leaves_;
};

}  // namespace palpate::vdb
