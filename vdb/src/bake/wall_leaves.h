#pragma once
/// Distances of an implicit field, combined with the faces of a box that cuts it.

#include "bake/implicit_distances.h"
#include "scan/distance_leaves.h"

namespace palpate::vdb {

/// Puts the voxels of the band into `grid`, including those of the band about the box's faces.
/// Tiles and inactive voxels keep the grid's background.
void addLeaves(const DistanceLeaves& leaves, const Field& field, const BakeDomain& domain,
               const BakePlan& plan, openvdb::FloatGrid& grid);

}  // namespace palpate::vdb
