#pragma once
/// Finds voxels of a leaf, and of the leaves around it, by their place.

#include <cstddef>
#include <cstdint>

#include "scan/distance_leaves.h"

namespace palpate::vdb {

[[nodiscard]] inline openvdb::Coord placeOf(std::size_t n) noexcept {
  const auto place = static_cast<int>(n);
  return {place >> 6, place >> 3 & 7, place & 7};
}

[[nodiscard]] inline std::size_t placeIn(const openvdb::Coord& voxel) noexcept {
  return static_cast<std::size_t>(((voxel.x() & 7) << 6) | ((voxel.y() & 7) << 3) |
                                  (voxel.z() & 7));
}

/// Closest points of voxels near one leaf, by their steps from it.
class Around {
 public:
  Around(const DistanceLeaves& leaves, const DistanceLeaf& leaf) : leaves_(leaves), leaf_(leaf) {}

  struct Voxel {
    const DistanceLeaf* leaf;
    std::size_t place;
  };
  /// Null: there is none. `at` is relative to the leaf's first voxel, -8 to 15.
  [[nodiscard]] Voxel at(const openvdb::Coord& at) const noexcept {
    const auto side = [](int i) { return (i >> 3) + 1; };
    const int n = 9 * side(at.x()) + 3 * side(at.y()) + side(at.z());
    const std::int32_t index = leaf_.near[static_cast<std::size_t>(n)];
    if (index < 0) return {nullptr, 0};
    return {&leaves_.all()[static_cast<std::size_t>(index)], placeIn(at)};
  }

 private:
  const DistanceLeaves& leaves_;
  const DistanceLeaf& leaf_;
};

}  // namespace palpate::vdb
