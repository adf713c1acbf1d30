#pragma once
/// For each voxel of a block, the distance to the nearest voxel on the other side of a mask.

#include <array>
#include <vector>

#include "palpate/core/math.h"
#include "scan/mask.h"

namespace palpate::vdb {

/// Distance transforms along one axis after another (P. Felzenszwalb and D. Huttenlocher, 2012), to
/// voxels at most kReach steps away along each axis. Space beyond the image is on neither side.
class Opposite {
 public:
  static constexpr int kReach = 5;
  static constexpr int kSide = 8;

  /// `spacing` of the voxels along each axis, in steps of the smallest.
  explicit Opposite(const Vec3& spacing);

  /// Results for voxels (8 z + y) 8 + x of a block.
  struct Found {
    alignas(32) std::array<float, 512> square;  ///< [steps^2] to the nearest; kNone: there is none
    alignas(32) std::array<float, 512> voxels;  ///< [voxels^2] for the same voxel; the shortest if
                                                ///< several are equally near
  };
  static constexpr float kNone = 1e9F;

  /// Searches the block whose first voxel is box voxel `first`. False if everything within reach is
  /// on one side; then nothing is found.
  bool find(const Mask& mask, const std::array<int, 3>& first, Found& found) const noexcept;

 private:
  template <bool kCubic>
  bool findIn(const Mask& mask, const std::array<int, 3>& first, Found& found) const noexcept;

  bool is_cubic_;
  std::array<std::array<float, kReach + 1>, 3>
      squares_{};  ///< [steps^2] for a number of voxels along each axis
  /// Steps to the nearest set bit among eleven voxels; 255: no bit is set.
  std::vector<std::uint8_t> nearest_;
};

}  // namespace palpate::vdb
