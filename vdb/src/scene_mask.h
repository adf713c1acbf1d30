#pragma once
/// Surfaces of grids whose voxels tell inside from outside but hold no distances: booleans, masks
/// and densities.

#include <optional>
#include <string>

#include "palpate/vdb/bake.h"

namespace palpate::vdb {

struct MaskOptions {
  std::string file;
  std::string name;             ///< of the grid; empty: the only one
  std::string unit_if_missing;  ///< unit of lengths, where the file does not state one
  std::optional<double>
      above;                ///< densities only: inside is where they are greater; not given: 0.5
  double voxel_size = 0.0;  ///< [m] for the surface; 0: the grid's
};

/// A grid of booleans or integers, or a mask, encloses the voxels that are not 0; a fog volume is
/// cut at the density `above`. @throws Error (kInput): a level set (it holds distances, and is not
/// a mask), a grid of vectors, `above` for a grid without densities, nothing enclosed.
[[nodiscard]] LevelSet surfaceOfMask(const MaskOptions& options, const BakeOptions& bake,
                                     const Progress& progress = {});

}  // namespace palpate::vdb
