#pragma once
/// Facts about a grid that are needed before it can become a field, found in one pass over all
/// voxels.

#include <openvdb/openvdb.h>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

struct Survey {
  openvdb::CoordBBox inside;  ///< box of the voxels with negative values
  openvdb::CoordBBox known;   ///< box of the active voxels
  double steepest = 0.0;      ///< largest |gradient| of the trilinear interpolant [-]
};

/// [units] The value that a voxel outside the band counts as. Its distance is at least the half
/// width, but between such voxels the surface can be nearer than the mean of their values says. The
/// distance to something at a distance rho has curvatures of at most 1 / rho along two axes.
/// Trilinear means are off by voxel^2 / 8 times that (counted for three axes, to be safe, and no
/// cell is farther from its voxels than 0.87); those of the cubic spline by voxel^2 / 6, with
/// voxels up to 3.5 away.
[[nodiscard]] float plateauOf(const LevelSetInfo& info, Sampler sampler) noexcept;

/// `plateau` [units] is used as the absolute value of every voxel that is not active.
[[nodiscard]] Survey surveyGrid(const openvdb::FloatGrid& grid, float plateau);

}  // namespace palpate::vdb
