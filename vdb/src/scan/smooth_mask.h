#pragma once
/// A smooth surface through the voxels of a mask.

#include "palpate/core/progress.h"
#include "scan/band.h"

namespace palpate::vdb {

/// Moves the values of a band made by bandOf() until they bend as little as the bounds allow: the
/// sum of squares of all second derivatives, in the band and free at its edge, falls by accelerated
/// projected gradient steps. That alone flattens what is curved; so halfway the values are made
/// distances again, and from there only what bends them unevenly counts: forces that vary slowly
/// along the surface, and those at the band's edge, are taken out.
///
/// Values end about as distances, in steps of the smallest spacing. The number of steps is fixed
/// and nothing global is looked at, so a value depends on voxels nearby alone, and turning the mask
/// inside out turns all signs, bit by bit. Does not depend on the number of threads. `axes`:
/// columns, in steps of the smallest spacing. A shear enters the distances, not the energy.
void smoothBand(Band& band, const Mask& mask, const Mat3& axes, const Progress& progress);

}  // namespace palpate::vdb
