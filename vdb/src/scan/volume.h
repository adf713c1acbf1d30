#pragma once
/// The volume within the surface of a band.

#include <functional>

#include "scan/band.h"

namespace palpate::vdb {

/// Moves the whole surface, by at most a fraction of a voxel, so that it encloses as much as the
/// voxels of the mask do, each voxel within its bounds. What it encloses is read off the lines
/// through the voxel centers, along each axis: where the spline passes zero between an inside voxel
/// and its neighbor outside, where voxels end half-way. Returns what it still encloses more than
/// the voxels [voxels].
double keepVolume(Band& band, const Mask& mask);

/// [steps] What has to be taken off other values of the same band, so that their surface encloses
/// `excess` [voxels] less than its own does: the first step of Newton's search, along straight
/// lines between voxels. At most a fraction of a voxel. `other`: the value at an index of the image
/// that has this one in the band. Called from several threads.
[[nodiscard]] float shiftToVolumeOf(const Band& band, const Mask& mask, double excess,
                                    const std::function<float(float, int, int, int)>& other);

}  // namespace palpate::vdb
