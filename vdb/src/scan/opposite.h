#pragma once
/// For each voxel of a block, the distance to the nearest voxel on the other side of a mask.

#include <array>

#include "palpate/core/math.h"
#include "scan/mask.h"

namespace palpate::vdb {

/// Distance transforms along one axis after another (P. Felzenszwalb and D. Huttenlocher, 2012), to
/// voxels within a box around each. Along each axis that reaches as far as kReach voxels reach
/// along any: the nearest of the voxels seen is the nearest of all. Space beyond the image is on
/// neither side.
class Opposite {
 public:
  static constexpr int kReach = 5;
  static constexpr int kMostReach = 20;  ///< along any axis, where spacings differ by more than 4
  static constexpr int kSide = 8;

  /// `spacing` of the voxels along each axis, in steps of the smallest.
  explicit Opposite(const Vec3& spacing);

  /// Results for voxels (8 z + y) 8 + x of a block.
  struct Found {
    alignas(32) std::array<float, 512> square;  ///< [steps^2] to the nearest; kNone: there is none
    alignas(32) std::array<float, 512> voxels;  ///< [voxels^2] to the same voxel; the least if
                                                ///< several are equally near
    alignas(32) std::array<float, 512> fewest;  ///< [voxels^2] to the nearest counted in voxels
  };
  static constexpr float kNone = 1e9F;

  /// Searches the block whose first voxel is box voxel `first`. False if everything within reach is
  /// on one side; then nothing is found.
  bool find(const Mask& mask, const std::array<int, 3>& first, Found& found) const noexcept;

  /// [steps] All voxels that are nearer than this are seen.
  [[nodiscard]] double seen() const noexcept { return seen_; }

 private:
  template <bool kCubic>
  bool findIn(const Mask& mask, const std::array<int, 3>& first, Found& found) const noexcept;

  bool is_cubic_;
  double seen_;
  std::array<int, 3> reach_{};  ///< [voxels] along each axis
  std::array<std::array<float, kMostReach + 1>, 3>
      squares_{};  ///< [steps^2] for a number of voxels along each axis
};

}  // namespace palpate::vdb
