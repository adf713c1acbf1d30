#pragma once
/// Finds the region of an imported scan at a point, by the nearest voxel.

#include <cstddef>
#include <unordered_map>

#include "import/imported_scene.h"

namespace palpate::tools {

class RegionSampler {
 public:
  /// `scan` must outlive this.
  explicit RegionSampler(const ImportedScan& scan);

  struct Sample {
    std::size_t region = 0;     ///< or survey.gap(), or survey.outside()
    bool is_at_border = false;  ///< the voxel is an outermost one of the image, or there is none
  };
  /// `world` [m].
  [[nodiscard]] Sample at(const Vec3& world) const;

  /// [m] Box around the centers of all voxels that are not outside.
  [[nodiscard]] const Box3& box() const { return box_; }

 private:
  const ImportedScan& scan_;
  Mat3 to_index_;
  std::unordered_map<int, std::size_t> region_of_;
  Box3 box_;
};

}  // namespace palpate::tools
