#pragma once
/// The volume within the surface of a band.

#include "scan/band.h"

namespace palpate::vdb {

/// Moves the whole surface, by at most a fraction of a voxel, so that it encloses as much as the voxels of the mask
/// do, each voxel within its bounds. What it encloses is read off the lines through the voxel centers, along each
/// axis: where the spline passes zero between an inside voxel and its neighbor outside, where voxels end half-way.
void keepVolume(Band& band, const Mask& mask);

}  // namespace palpate::vdb
