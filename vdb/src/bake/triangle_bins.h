#pragma once
/// Finds the triangles that the band of each leaf can touch.

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/bake_plan.h"

namespace palpate::vdb {

/// Leaves in a fixed order, each with its triangles in rising order.
class TriangleBins {
 public:
  /// `vertices` [voxels]; `range` holds every voxel that the band can touch; it is less than 2^24
  /// long on each axis. @throws Error (kCancelled).
  TriangleBins(const std::vector<Vec3>& vertices,
               const std::vector<std::array<std::uint32_t, 3>>& triangles,
               const openvdb::CoordBBox& range, const BakePlan& plan, const Progress& progress);

  [[nodiscard]] std::size_t size() const noexcept { return first_.size() - 1; }
  [[nodiscard]] openvdb::Coord origin(std::size_t leaf) const noexcept;
  /// The leaf with this voxel, if it has triangles.
  [[nodiscard]] std::optional<std::size_t> find(const openvdb::Coord& voxel) const noexcept;
  [[nodiscard]] std::span<const std::uint32_t> triangles(std::size_t leaf) const noexcept {
    return std::span(triangles_).subspan(first_[leaf], first_[leaf + 1] - first_[leaf]);
  }

 private:
  openvdb::Coord lo_;
  std::array<int, 3> bits_{};             ///< number of bits of a leaf's coordinates in its key
  std::vector<std::uint64_t> keys_;       ///< of the leaves, in rising order
  std::vector<std::size_t> first_;        ///< index of each leaf's first triangle, and an end
  std::vector<std::uint32_t> triangles_;  ///< leaf by leaf
};

}  // namespace palpate::vdb
