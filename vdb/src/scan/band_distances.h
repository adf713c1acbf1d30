#pragma once
/// Values of a band made distances again.

#include "scan/band.h"

namespace palpate::vdb {

/// Each voxel takes its distance to the surface that the values have now, within its bounds. Those
/// by the surface find its closest point along their slope, the others from those of their
/// neighbors, layer by layer. One whose distance would be of another place keeps its value. `axes`:
/// columns, in steps of the smallest spacing. Does not depend on the number of threads.
void makeDistances(Band& band, const Mask& mask, const Mat3& axes);

}  // namespace palpate::vdb
