#pragma once
/// Evenly spaced planes of which some may be missing.

#include <string>
#include <vector>

#include "image/place.h"

namespace palpate::vdb {

/// Planes that are parallel, and where their first pixel lies. [mm], LPS.
struct PlaneSet {
  Vec3 along_row{1.0, 0.0, 0.0};
  Vec3 along_column{0.0, 1.0, 0.0};
  double row_spacing = 0.0;     ///< from row to row
  double column_spacing = 0.0;  ///< from column to column
  std::vector<Vec3> positions;  ///< in any order, as often as there are frames
  double stated_step = 0.0;     ///< from plane to plane; 0: not stated
};

struct PlaneGrid {
  int count = 0;           ///< of planes, missing ones included
  std::vector<int> index;  ///< of each position, from 0
  Vec3 step{0.0};          ///< [mm] from plane to plane
  Vec3 first{0.0};         ///< [mm] position of plane 0
};

/// The planes that all positions are of. The step is the stated one if that fits, else the least
/// gap. `margin` empty planes are added at both ends. @throws Error (kInput, dicom.spacing) if no
/// step fits.
[[nodiscard]] PlaneGrid planeGrid(const PlaneSet& planes, int margin, const std::string& path,
                                  std::vector<std::string>& notes);

/// Of the voxels, [m], RAS. @throws Error (kInput, dicom.singular).
[[nodiscard]] Place placeOf(const PlaneSet& planes, const PlaneGrid& grid, const std::string& path);

}  // namespace palpate::vdb
