#pragma once
/// What has to be known of a grid before it can be a field: one look at all its voxels.

#include <openvdb/openvdb.h>

namespace palpate::vdb {

struct Survey {
  openvdb::CoordBBox inside;  ///< of the voxels with negative values
  openvdb::CoordBBox known;   ///< of the active voxels
  double steepest = 0.0;      ///< largest |gradient| of the trilinear interpolant [-]
};

/// `plateau` [units] stands for the size of every value that is not active.
[[nodiscard]] Survey surveyGrid(const openvdb::FloatGrid& grid, float plateau);

}  // namespace palpate::vdb
