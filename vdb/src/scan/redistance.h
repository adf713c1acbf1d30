#pragma once
/// The distance to the surface of a spline on an image's lattice, on cubic voxels along the world's
/// axes.

#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"
#include "scan/band.h"
#include "scan/lattice_spline.h"

namespace palpate::vdb {

/// The zero set of `spline` as a level set: each voxel of the band has the distance to its closest
/// point, by Newton's method. Voxels around where the surface crosses an edge of the lattice start
/// from that crossing, the others from the closest points of their neighbors, layer by layer; at
/// last each looks once more whether a neighbor's is nearer. `band` and `mask` are the spline's:
/// every pair of neighbors on two sides of the mask has a crossing, so that no part of the surface
/// is missed.
///
/// Where Newton's method leads nowhere (a crease of the spline), the distance is to the nearest
/// crossing or neighbor's point. Does not depend on the number of threads. @throws Error as bake().
[[nodiscard]] LevelSet bakeSpline(const LatticeSpline& spline, const Band& band, const Mask& mask,
                                  const Image& image, const BakeOptions& options,
                                  const Progress& progress);

}  // namespace palpate::vdb
