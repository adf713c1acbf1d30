#pragma once
/// Turns the values of a band into distances again.

#include "scan/band.h"

namespace palpate::vdb {

/// Each voxel takes its distance to the surface of the present values, within its bounds. Voxels
/// next to the surface find its closest point along their gradient, the others start from the
/// closest points of their neighbors, layer by layer. A voxel whose new distance would belong to
/// another place keeps its value. `axes`: columns, in steps of the smallest spacing. The result
/// does not depend on the number of threads.
void makeDistances(Band& band, const Mask& mask, const Mat3& axes);

}  // namespace palpate::vdb
