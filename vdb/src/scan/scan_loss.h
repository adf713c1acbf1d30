#pragma once
/// Finds the voxels of a scan that a grid has on the wrong side.

#include <map>
#include <string>

#include "palpate/vdb/level_set.h"
#include "palpate/vdb/scan_surface.h"
#include "scan/band.h"

namespace palpate::vdb {

/// Examines every voxel of the band, by trilinear interpolation of the grid at its center, except
/// those that `apart` holds (it is empty, or has the mask's box).
[[nodiscard]] ScanLoss findLoss(const LevelSet& grid, const Band& band, const Mask& mask,
                                const Mask& apart, const Image& image);

/// The loss as metadata, which scanLoss() reads; empty if nothing was lost.
[[nodiscard]] std::map<std::string, std::string> metadataOf(const ScanLoss& loss);

}  // namespace palpate::vdb
