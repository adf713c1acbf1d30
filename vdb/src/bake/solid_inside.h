#pragma once
/// Tells inside from outside of a solid at any point.

#include <cstdint>
#include <vector>

#include "bake/columns.h"
#include "bake/solid.h"
#include "bake/wall_count.h"

namespace palpate::vdb {

/// Counts the walls below a point. The solid's triangles are listed by the cells of a grid in the
/// plane z = 0. Thread-safe, with a counter() for each thread.
class SolidInside {
 public:
  /// Both must outlive it, and `solid` must still have all the walls that `columns` were made from.
  SolidInside(const Solid& solid, const Columns& columns);

  [[nodiscard]] WallCount counter() const { return WallCount(columns_.roles()); }

  /// `p` [voxels]. A flood fill is known at voxels only: a point it filled is inside if all voxels
  /// around the point are.
  [[nodiscard]] bool at(const Vec3& p, WallCount& count) const;

 private:
  [[nodiscard]] bool isBetweenWalls(const Vec3& p, WallCount& count) const;
  [[nodiscard]] std::uint64_t cellAlong(double v, int axis, std::uint64_t count) const;

  const Solid& solid_;
  const Columns& columns_;
  Box3 box_;
  double cell_ = 1.0;
  std::uint64_t nx_ = 1;
  std::uint64_t ny_ = 1;
  std::vector<std::size_t> first_;        ///< index of each cell's first triangle, and an end
  std::vector<std::uint32_t> triangles_;  ///< cell by cell
};

}  // namespace palpate::vdb
