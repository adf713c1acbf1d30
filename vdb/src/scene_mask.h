#pragma once
/// Grids that say where, not how far: booleans, masks and densities, as the surface of what they
/// hold.

#include <optional>
#include <string>

#include "palpate/vdb/bake.h"

namespace palpate::vdb {

struct MaskOptions {
  std::string file;
  std::string name;             ///< of the grid; empty: the only one
  std::string unit_if_missing;  ///< of its lengths, where the file does not say
  std::optional<double>
      above;                ///< densities only: inside is where they are greater; not given: 0.5
  double voxel_size = 0.0;  ///< [m] of the surface; 0: the grid's
};

/// A grid of booleans, integers or a mask holds the voxels that are not 0; a fog volume is cut
/// where its density is `above`. @throws Error (kInput): a level set (it says how far, and is not a
/// mask), a grid of vectors, `above` for one without densities, nothing held.
[[nodiscard]] LevelSet surfaceOfMask(const MaskOptions& options, const BakeOptions& bake,
                                     const Progress& progress = {});

}  // namespace palpate::vdb
