#pragma once
/// Makes grids from grids.

#include "baking.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/image.h"

namespace palpate::tools {

/// Reads the level set of a .vdb file that the options name. If its inside is not marked, it is
/// marked, with a note.
/// @throws Error as vdb::readVdb() and vdb::withInsideMarked() do.
[[nodiscard]] vdb::MarkedInside readLevelSet(const BakeOptions& options, Console& console);

/// The grid's own length unit, or --units; may be empty.
[[nodiscard]] std::string unitOfGrid(const BakeOptions& options);

/// Whether readLevelSet() threw the error only because of the grid's transform or number type.
[[nodiscard]] bool isMendable(const Error& error, const BakeOptions& options);

/// Reads a level set, with its inside marked, even if readLevelSet() refuses its transform or its
/// number type. Values are in its own length unit.
[[nodiscard]] vdb::Image readDistances(const BakeOptions& options, Console& console);

/// If readLevelSet() refuses the grid for its transform or its number type: a grid of cubic voxels
/// along the axes. Otherwise: the same surface with voxels of --voxel; or, without --voxel, the
/// grid with its inside marked.
/// @throws Error: kUsage without --voxel if there is nothing to mend.
[[nodiscard]] BakedGrid rebakeGrid(const BakeOptions& options, Console& console);

/// Gives grids that were made from a grid the frame of that grid.
[[nodiscard]] std::vector<BakedGrid> inTheSameFrame(const BakeOptions& options,
                                                    std::vector<BakedGrid> grids);

/// Reads the voxels of a .nii file, or of a grid of densities or labels, and the unit of their
/// places.
[[nodiscard]] vdb::Image readVoxels(const BakeOptions& options, std::string& length_unit);

}  // namespace palpate::tools
