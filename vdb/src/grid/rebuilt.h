#pragma once
/// Distances of a grid made anew from its surface.

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Keeps the voxels beside the surface, and finds the others from them, as widened() does; as wide
/// as before, and wide enough for the cubic sampler. Voxels beside the surface must be whole, and
/// the inside marked.
[[nodiscard]] LevelSet withDistancesRebuilt(const LevelSet& grid, const Progress& progress);

}  // namespace palpate::vdb
