#pragma once
/// What has to be known of a grid before it can be a field: one look at all its voxels.

#include <openvdb/openvdb.h>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct Survey {
  openvdb::CoordBBox inside;  ///< of the voxels with negative values
  openvdb::CoordBBox known;   ///< of the active voxels
  double steepest = 0.0;      ///< largest |gradient| of the trilinear interpolant [-]
};

/// [units] What a voxel outside the band counts: its distance is at least the half width, but
/// between such voxels the surface can be nearer than the mean of them says. A distance to
/// something rho away bends by at most 1 / rho along two axes; trilinear means are off by voxel^2 /
/// 8 of that (three axes, to be safe, and no cell is further from its voxels than 0.87), those of
/// the cubic spline by voxel^2 / 6, from voxels up to 3.5 off.
[[nodiscard]] float plateauOf(const LevelSetInfo& info, Sampler sampler) noexcept;

/// `plateau` [units] stands for the size of every value that is not active.
[[nodiscard]] Survey surveyGrid(const openvdb::FloatGrid& grid, float plateau);

}  // namespace palpate::vdb
