#pragma once
/// A level set as an image.

#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Voxel by voxel, over the box of the active ones: signed distances in the grid's length unit, the
/// background's beyond the band. The image's axes are the world's.
/// @throws Error: kInput for a grid without active voxels; kOperation if the box has more than 10^9
/// voxels (4 GB).
[[nodiscard]] Image gridImage(const LevelSet& grid);

}  // namespace palpate::vdb
