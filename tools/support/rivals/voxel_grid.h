#pragma once
/// Occupancy of voxels, and the gradients that can be computed from it.

#include <array>
#include <vector>

#include "palpate/fields/field.h"
#include "support/rivals/rivals.h"

namespace palpate::rivals {

/// Values from 0 (empty) to 1 (full), at the voxels' centers. Immutable; real-time safe except for
/// the constructor.
class VoxelGrid {
 public:
  /// Occupancy of `field` in `box` [m]. With a ramp of w voxels the value is 1/2 - S / (w h),
  /// clamped to 0 and 1.
  VoxelGrid(const Field& field, const Box3& box, const Voxels& voxels);

  /// [-] Interpolated from the eight voxels around `p` [m].
  [[nodiscard]] double value(const Vec3& p) const noexcept;
  /// [1/m] By Voxels::gradient: at the nearest voxel by central differences or Sobel's operator, or
  /// the central differences at the eight voxels around, interpolated.
  [[nodiscard]] Vec3 gradient(const Vec3& p) const noexcept;

 private:
  using Index = std::array<int, 3>;
  [[nodiscard]] double at(int x, int y, int z) const noexcept;
  [[nodiscard]] Vec3 central(const Index& i) const noexcept;
  [[nodiscard]] Vec3 sobel(const Index& i) const noexcept;

  Vec3 lo_;
  double size_;
  Voxels::Gradient kind_;
  Index count_{};
  std::vector<float> values_;
};

}  // namespace palpate::rivals
