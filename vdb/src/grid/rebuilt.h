#pragma once
/// Rebuilds the distances of a grid from its surface.

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Keeps the voxels beside the surface, and computes the others from them, as widened() does. The
/// band is as wide as before, and wide enough for the cubic sampler. Voxels beside the surface must
/// be sound, and the inside marked.
[[nodiscard]] LevelSet withDistancesRebuilt(const LevelSet& grid, const Progress& progress);

}  // namespace palpate::vdb
