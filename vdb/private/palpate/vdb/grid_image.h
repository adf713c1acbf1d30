#pragma once
/// Grids as images.

#include <cstdint>
#include <string>

#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Voxel by voxel, over the box of the active ones: signed distances in the grid's length unit;
/// beyond the band, the background's value. The image's axes are the world's.
/// @throws Error: kInput for a grid without active voxels; kOperation if the box has more than 10^9
/// voxels (4 GB).
[[nodiscard]] Image gridImage(const LevelSet& grid);

/// Any grid of one number a voxel (float, double, int, bool, mask) in a .vdb file, whatever its
/// class: values as they are, over the box of the active voxels and one more voxel on every side,
/// placed by the grid's transform, which may rotate, shear, mirror and stretch. `name` and
/// `unit_if_missing` as for readVdb().
/// @throws Error: kInput as readVdb() does, vdb.type for grids of vectors and points, vdb.transform
/// for one that is not linear; kOperation as gridImage() does.
[[nodiscard]] Image readVdbImage(const std::string& path, const std::string& name,
                                 const std::string& unit_if_missing);

/// Signed distances as an image, and how many voxels beyond the band had to change their sign for
/// it.
struct DistanceImage {
  Image image;
  std::uint64_t marked_inside = 0;
};

/// The same for a grid of floats or doubles that holds signed distances, with the signs of its
/// inside corrected as by withInsideMarked(). @throws Error as both.
[[nodiscard]] DistanceImage readVdbDistances(const std::string& path, const std::string& name,
                                             const std::string& unit_if_missing);

}  // namespace palpate::vdb
