#pragma once
/// Computes the distance to the surface of a spline on an image's lattice, for cubic voxels along
/// the world's axes.

#include <openvdb/openvdb.h>

#include <functional>

#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"
#include "scan/band.h"
#include "scan/lattice_spline.h"

namespace palpate::vdb {

/// The zero set of `spline` as a level set: each voxel of the band gets the distance to its closest
/// point, by Newton's method. Voxels around the place where the surface crosses an edge of the
/// lattice start from that crossing, the others from the closest points of their neighbors, layer
/// by layer; at the end each voxel checks once more whether a neighbor's point is nearer. `band`
/// and `mask` are the spline's: every pair of neighbors on two sides of the mask has a crossing, so
/// that no part of the surface is missed.
///
/// Voxel (0, 0, 0) has its center at `phase` [m]. The spline's places are counted from there.
/// `last` may still change values.
///
/// Where Newton's method fails (a crease of the spline), the distance is that to the nearest
/// crossing or neighbor's point. The result does not depend on the number of threads. @throws Error
/// as bake().
[[nodiscard]] LevelSet bakeSpline(
    const LatticeSpline& spline, const Band& band, const Mask& mask, const Image& image,
    const BakeOptions& options, const Progress& progress, const Vec3& phase = Vec3(0.0),
    const std::function<void(const openvdb::FloatGrid::Ptr&)>& last = {});

}  // namespace palpate::vdb
