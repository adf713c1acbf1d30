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

/// [units] The value that stands for each voxel outside the band: the half width less the error of
/// interpolation, because between such voxels the surface can be nearer than their values. At rho
/// from the surface, distances have curvatures of at most 1 / rho along two axes. Trilinear values
/// are off by voxel^2 / 8 times the curvatures (counted for three axes, to be safe, at a rho of the
/// half width less 0.87 voxel), the cubic spline by voxel^2 / 6 times them (at the half width less
/// 3.5).
[[nodiscard]] float plateauOf(const LevelSetInfo& info, Sampler sampler) noexcept;

/// `plateau` [units] is used as the absolute value of every voxel that is not active.
[[nodiscard]] Survey surveyGrid(const openvdb::FloatGrid& grid, float plateau);

}  // namespace palpate::vdb
