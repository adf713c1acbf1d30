#pragma once
/// Fields and meshes -> narrow-band level sets, in parallel (TBB).

#include <optional>
#include <string>

#include "palpate/vdb/level_set.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

struct BakeOptions {
  double voxel_size = 0.0;              ///< [m] must be positive
  double half_width = kCubicHalfWidth;  ///< [voxels] at least 2
  /// [m] where to bake; needed for unbounded fields. What reaches out of it is cut off by its faces,
  /// so that the result is closed.
  std::optional<Box3> box = {};
  std::string name = "surface";
  std::string length_unit = "mm";  ///< unit that the grid's world coordinates are stored in
  std::uint64_t max_memory = 0;    ///< [bytes] 0: 80 % of the machine's
  std::map<std::string, std::string> metadata = {};
};

/// Voxel (0, 0, 0) has its centre at the origin. Values are the field's own if it is exact or a
/// bound; the exact distance by projection if it is implicit (footPoint(); S / |grad S| where no
/// nearest point is found); and, unless it is exact, more than that far out, so that the band ends
/// within its half width of the field's bounds.
/// Active are the voxels with |value| less than half_width voxels. The result does not depend on the
/// number of threads.
/// @throws Error: kInput for options or an empty result (a shape the voxels cannot hold), kOperation
/// for memory, kCancelled.
[[nodiscard]] LevelSet bake(const Field& field, const BakeOptions& options,
                            const Progress& progress = {});

/// `mesh` must be closed (checkMesh()); an open one is refused, naming its boundary edges.
[[nodiscard]] LevelSet bakeMesh(const Mesh& mesh, const BakeOptions& options,
                                const Progress& progress = {});

}  // namespace palpate::vdb
