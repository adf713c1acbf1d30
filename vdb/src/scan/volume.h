#pragma once
/// Corrects the volume within the surface of a band.

#include <functional>

#include "scan/band.h"

namespace palpate::vdb {

/// Moves the whole surface, by at most a fraction of a voxel, so that it encloses as much volume as
/// the voxels of the mask, each voxel staying within its bounds. The volume is measured along the
/// lines through the voxel centers, along each axis: from where the spline passes zero between an
/// inside voxel and its outside neighbor; the voxels' own border is half-way between the two. Each
/// line counts by the square of the cosine between it and the surface's normal.
/// Returns the volume that the surface still encloses beyond that of the voxels [voxels].
double keepVolume(Band& band, const Mask& mask);

/// [steps] The number to subtract from other values on the same band, so that their surface
/// encloses `excess` [voxels] less than it does now: the first step of Newton's search, along
/// straight lines between voxels. At most a fraction of a voxel. `other`: gives the other value at
/// an index of the image, from the value of this band there. Called from several threads.
[[nodiscard]] float shiftToVolumeOf(const Band& band, const Mask& mask, double excess,
                                    const std::function<float(float, int, int, int)>& other);

}  // namespace palpate::vdb
