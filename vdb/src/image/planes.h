#pragma once
/// Evenly spaced planes, some of which may be missing.

#include <string>
#include <vector>

#include "image/place.h"

namespace palpate::vdb {

/// Parallel planes, and the positions of their first pixels. [mm], LPS.
struct PlaneSet {
  Vec3 along_row{1.0, 0.0, 0.0};
  Vec3 along_column{0.0, 1.0, 0.0};
  double row_spacing = 0.0;     ///< from row to row
  double column_spacing = 0.0;  ///< from column to column
  std::vector<Vec3> positions;  ///< in any order, one for each frame
  double stated_step = 0.0;     ///< from plane to plane; 0: not stated
};

struct PlaneGrid {
  int count = 0;           ///< number of planes, missing ones included
  std::vector<int> index;  ///< plane of each position, from 0
  Vec3 step{0.0};          ///< [mm] from plane to plane
  Vec3 first{0.0};         ///< [mm] position of plane 0
};

/// The evenly spaced planes that all positions lie on. The step is the stated one if it fits,
/// otherwise the least gap. `margin` empty planes are added at both ends. @throws Error (kInput,
/// dicom.spacing) if no step fits.
[[nodiscard]] PlaneGrid planeGrid(const PlaneSet& planes, int margin, const std::string& path,
                                  std::vector<std::string>& notes);

/// The place of the voxels: [m], RAS. @throws Error (kInput, dicom.singular).
[[nodiscard]] Place placeOf(const PlaneSet& planes, const PlaneGrid& grid, const std::string& path);

}  // namespace palpate::vdb
