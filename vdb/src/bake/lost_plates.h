#pragma once
// Thin parts that a grid of them has lost.

#include <string>

#include "bake/bake_plan.h"

namespace palpate::vdb {

/// A plate thinner than about a voxel has no voxel inside where it passes between them: holes, which a hand
/// falls through. Looks for such places from every voxel by the surface; a place counts where the
/// shape goes on for two voxels to all sides, so that the last voxel of a sharp edge or a tip does not.
/// @throws Error (kInput) naming one, the thickness there and a voxel size that holds it.
void refuseLostPlates(const Field& field, const LevelSet& grid, const BakePlan& plan,
                      const BakeOptions& options);

}  // namespace palpate::vdb
