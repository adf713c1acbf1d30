#pragma once
/// Keeps the voxel centers of an image in their layers.

#include <openvdb/openvdb.h>

#include <string>

#include "bake/bake_plan.h"
#include "palpate/vdb/image.h"
#include "scan/label_partition.h"

namespace palpate::vdb {

/// Distances of two lapped layers to their own walls need not be in the order of the values that
/// the walls were made of: where walls bend sharply, a center could get into the other layer. So
/// values at the layer's own centers are kept below the value at which layers part, and all others
/// above it; for a center between the grid's voxels, those around it are changed, unless they are
/// larger than the image's. `phase` [m]: center of the grid's voxel (0, 0, 0).
void keepCenters(const openvdb::FloatGrid::Ptr& grid, const MaskedBand& layer, const Image& image,
                 const Vec3& phase, const BakePlan& plan, const std::string& length_unit);

}  // namespace palpate::vdb
