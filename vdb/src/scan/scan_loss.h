#pragma once
/// Which of a scan's voxels a grid has on the wrong side.

#include <map>
#include <string>

#include "palpate/vdb/level_set.h"
#include "palpate/vdb/scan_surface.h"
#include "scan/band.h"

namespace palpate::vdb {

/// Looks at every voxel of the band, by trilinear interpolation of the grid at its center; not at
/// those that `apart` holds (nothing, or of the mask's box).
[[nodiscard]] ScanLoss findLoss(const LevelSet& grid, const Band& band, const Mask& mask,
                                const Mask& apart, const Image& image);

/// As metadata, for scanLoss() to read; none if nothing was lost.
[[nodiscard]] std::map<std::string, std::string> metadataOf(const ScanLoss& loss);

}  // namespace palpate::vdb
