#pragma once
/// Finds a smooth surface through the voxels of a mask.

#include "palpate/core/progress.h"
#include "scan/band.h"

namespace palpate::vdb {

/// Moves the values of a band made by bandOf() until they bend as little as the bounds allow: the
/// sum of squares of all second derivatives, in the band and free at its edge, is reduced by
/// accelerated projected gradient steps. That alone flattens curved surfaces. Therefore halfway the
/// values are turned into distances again, and from there on only uneven bending counts: forces
/// that vary slowly along the surface, and those at the band's edge, are subtracted.
///
/// The final values are approximately distances, in steps of the smallest spacing. The number of
/// steps is fixed and nothing global is used, so that a value depends on nearby voxels only, and
/// turning the mask inside out negates all values, bit by bit. The result does not depend on the
/// number of threads. `axes`: columns, in steps of the smallest spacing. A shear affects the
/// distances, not the energy.
void smoothBand(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress);

}  // namespace palpate::vdb
