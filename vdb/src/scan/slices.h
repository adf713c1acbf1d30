#pragma once
/// Distances within the slices of a scan whose slices are much thicker than its voxels are wide.

#include <array>
#include <optional>
#include <vector>

#include "palpate/core/math.h"
#include "scan/mask.h"

namespace palpate::vdb {

/// Signed distances to the mask's outline, in each slice by itself. Between two slices the
/// distances are interpolated, so that the outlines in between lead from one slice to the next (S.
/// P. Raya and J. K. Udupa, "Shape-based interpolation", 1990). Where a surface is nearly parallel
/// to the slices, its place follows from outlines far away, not only from the steps between
/// neighbors.
class SliceDistances {
 public:
  /// Nothing unless one spacing is at least 1.5 times the others. `spacing` in steps of the
  /// smallest.
  [[nodiscard]] static std::optional<SliceDistances> of(const Mask& mask, const Vec3& spacing);

  /// [steps] Approximate distance of a voxel of the box from the surface, without sign; nothing
  /// where the slice has no outline.
  [[nodiscard]] std::optional<double> distanceAt(const std::array<int, 3>& at) const noexcept;

 private:
  SliceDistances(const Mask& mask, const Vec3& spacing, int axis);
  void measureSlice(const Mask& mask, int slice);
  [[nodiscard]] std::size_t placeOf(const std::array<int, 3>& at) const noexcept {
    return static_cast<std::size_t>(at[0]) +
           static_cast<std::size_t>(box_[0]) *
               (static_cast<std::size_t>(at[1]) +
                static_cast<std::size_t>(box_[1]) * static_cast<std::size_t>(at[2]));
  }

  std::array<int, 3> box_{};
  Vec3 spacing_{1.0, 1.0, 1.0};
  std::size_t axis_ = 2;       ///< perpendicular to the slices
  std::vector<float> values_;  ///< [steps] infinite: no outline
};

}  // namespace palpate::vdb
