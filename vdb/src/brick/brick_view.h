#pragma once
/// Haptic bricks as the kernels see them: a level set copied so that a query at a point needs one
/// lookup and one block of memory.

#include <cstddef>
#include <cstdint>

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// The stencils of all cells in a block of 8^3 voxels: from one voxel before the block to two
/// behind it.
struct alignas(64) Brick {
  static constexpr int kSide = 8;              ///< cells along an axis
  static constexpr std::ptrdiff_t kRows = 11;  ///< voxels along an axis, from -1 to 9
  static constexpr std::ptrdiff_t kRow = 12;  ///< floats from one row along z to the next: 48 bytes
  static constexpr std::ptrdiff_t kSlab = kRows * kRow;

  float values[kRows *
               kSlab];     ///< [voxels] spline coefficients, or the grid's values; z runs fastest
  std::uint8_t known[64];  ///< bit z of byte x * 8 + y: all voxels that this cell needs are known

  [[nodiscard]] static constexpr std::size_t at(int x, int y, int z) noexcept {
    return static_cast<std::size_t>((x + 1) * kSlab + (y + 1) * kRow + z + 1);
  }
};
static_assert(sizeof(Brick) == std::size_t{92} * 64);

/// Everything that a sample reads. Plain data; whoever made it owns the memory.
struct BrickView {
  /// Entries of the tables: a brick's place in units of 64 bytes, or one of these constants.
  static constexpr std::uint32_t kOutside = 0xFFFFFFFF;  ///< no brick, outside the surface
  static constexpr std::uint32_t kInside = 0xFFFFFFFE;   ///< no brick, inside
  static constexpr std::uint32_t kBeyond = 0xFFFFFFFD;   ///< in no table: beyond the box
  static constexpr std::uint32_t kUnit = 64;             ///< [bytes]

  const std::byte* bricks = nullptr;
  /// Entries for all blocks in the box, z fastest; or for the groups of 8^3 blocks that `coarse`
  /// finds.
  const std::uint32_t* blocks = nullptr;
  const std::uint32_t* coarse = nullptr;  ///< null if there is only one level
  std::uint32_t stride_x = 0;             ///< of the upper table
  std::uint32_t stride_y = 0;

  double per_voxel = 0.0;  ///< [1/m]
  Vec3 shift{0.0};  ///< [voxels] p * per_voxel + shift is 0 in the middle of the box's first cell
  std::uint64_t size[3] = {0, 0, 0};  ///< [voxels] size of the box, in whole blocks
  double voxel = 0.0;                 ///< [m]
  Vec3 origin{0.0};                   ///< [m] center of the box's first voxel
  double plateau = 0.0;  ///< [m] value outside the band, and least value beyond the box
};

/// Functions that query bricks, one for each kind of query.
struct BrickKernels {
  using Sample = FieldSample (*)(const BrickView&, const Vec3&) noexcept;
  using Jet = FieldJet (*)(const BrickView&, const Vec3&) noexcept;
  Sample cubic = nullptr;
  Jet cubic_jet = nullptr;
  Sample linear = nullptr;
};

/// The sample where there is no brick: `entry` is kOutside, kInside or kBeyond. Also for p that is
/// not a number.
[[nodiscard]] FieldSample sampleWithoutBrick(const BrickView& view, std::uint32_t entry,
                                             const Vec3& p) noexcept;

}  // namespace palpate::vdb
