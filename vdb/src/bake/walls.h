#pragma once
/// Which of a solid's triangles have the solid on one side only.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/columns.h"
#include "bake/solid.h"
#include "palpate/core/progress.h"

namespace palpate::vdb {

/// Without the parts of triangles that have the solid, or nothing, on both sides: where parts overlap,
/// and walls that stand in the solid. A triangle that is partly such is cut into pieces of a
/// tenth of a voxel along the border. Vertices are added; triangles that are whole keep their order.
/// @throws Error (kCancelled).
void dropIdleWalls(Solid& solid, const Columns& columns, const Progress& progress);

/// A place [voxels] within `box` where two triangles of one part, without a common vertex, meet; exact,
/// and touching counts (mesh/triangles_meet.h).
[[nodiscard]] std::optional<Vec3> findCrossing(const Solid& solid, const Box3& box);

}  // namespace palpate::vdb
