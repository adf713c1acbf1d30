#pragma once
/// Finds the triangles of a solid that have the solid on one side only.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/columns.h"
#include "bake/solid.h"
#include "palpate/core/bounds_tree.h"
#include "palpate/core/progress.h"

namespace palpate::vdb {

/// Removes the parts of triangles that have the solid on both sides, or on neither: where parts
/// overlap, and walls that stand inside the solid. A triangle of which this holds in part is cut
/// along the lines where others cross it (in a solid that a flood filled, to a tenth of a voxel).
/// Vertices are added; triangles that stay whole keep their order.
/// @throws Error (kCancelled).
void dropIdleWalls(Solid& solid, const Columns& columns, const Progress& progress);

/// Where the walls of a solid, which must outlive it, pass through each other.
class CrossingSearch {
 public:
  explicit CrossingSearch(const Solid& solid);

  /// A place [voxels] near `box` where two triangles of one part, without a common vertex, meet;
  /// exact, and touching counts (mesh/triangles_meet.h).
  [[nodiscard]] std::optional<Vec3> in(const Box3& box);

 private:
  const Solid& solid_;
  std::vector<Box3> boxes_;         ///< of the triangles
  std::optional<BoundsTree> tree_;  ///< of the same; made when it is first needed
};

}  // namespace palpate::vdb
