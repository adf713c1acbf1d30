#pragma once
/// Grids made of grids.

#include "baking.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/image.h"

namespace palpate::tools {

/// The level set of a .vdb file that the options name, its inside marked where it was not; a note
/// says so.
/// @throws Error as vdb::readVdb() and vdb::withInsideMarked() do.
[[nodiscard]] vdb::MarkedInside readLevelSet(const BakeOptions& options, Console& console);

/// The grid's own length unit, or --units; may be empty.
[[nodiscard]] std::string unitOfGrid(const BakeOptions& options);

/// Whether what readLevelSet() threw is about the grid's transform or number type only.
[[nodiscard]] bool isMendable(const Error& error, const BakeOptions& options);

/// A level set that readLevelSet() may refuse for those, its inside marked; values in its own
/// length unit.
[[nodiscard]] vdb::Image readDistances(const BakeOptions& options, Console& console);

/// What readLevelSet() refuses for its transform or its number type, as a grid of cubic voxels
/// along the axes; else the same surface with voxels of --voxel; or the grid as it is but for its
/// inside, where that was not marked.
/// @throws Error: kUsage without --voxel where there is nothing to mend.
[[nodiscard]] BakedGrid rebakeGrid(const BakeOptions& options, Console& console);

/// Grids made of a grid say the frame of that one.
[[nodiscard]] std::vector<BakedGrid> inTheSameFrame(const BakeOptions& options,
                                                    std::vector<BakedGrid> grids);

/// The voxels of a .nii file, or of a grid of densities or labels, and the unit that they are
/// placed in.
[[nodiscard]] vdb::Image readVoxels(const BakeOptions& options, std::string& length_unit);

}  // namespace palpate::tools
