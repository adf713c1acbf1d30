#pragma once
/// The voxels around the surface of a mask, in blocks, and the bounds of their distances.

#include <array>
#include <cstdint>
#include <vector>

#include "huge_vector.h"
#include "palpate/core/math.h"
#include "scan/mask.h"

namespace palpate::vdb {

/// 8^3 voxels in OpenVDB's order: place 64 i + 8 j + k.
struct BandBlock {
  static constexpr int kSide = 8;
  static constexpr std::size_t kVoxels = 512;
  using Values = std::array<float, kVoxels>;

  alignas(32) Values value;             ///< NaN: not in the band
  std::uint64_t rows = 0;               ///< bit 8 i + j: the row has a voxel in the band
  std::array<int, 3> first{};           ///< box index of its first voxel, a multiple of 8
  std::array<std::int32_t, 27> near{};  ///< blocks around it, 9 di + 3 dj + dk from -1 on; -1: none
};

/// Bounds of the values of a block.
struct BlockBounds {
  alignas(32) BandBlock::Values lower;
  alignas(32) BandBlock::Values upper;
};

/// All lengths are in steps of the smallest spacing. The band holds every voxel that has a voxel of
/// the other side within kReach voxels, and inside voxels that near to the image's border.
///
/// A shape that reaches the image's border ends there, half a voxel beyond its last voxel. In an
/// open band that is left out: values are those of the surface within the image, and voxels that
/// are near the border alone have none (NaN), so that the border bends no surface.
struct Band {
  static constexpr int kReach = 5;

  std::array<int, 3> first{};       ///< as in Mask
  std::array<int, 3> box{};         ///< as in Mask
  Vec3 spacing{1.0, 1.0, 1.0};      ///< of the voxels along each axis
  bool is_open = false;             ///< see above
  std::array<int, 3> table_size{};  ///< blocks along each axis
  std::vector<std::int32_t> table;  ///< index of each block in `blocks`, or -1; first axis fastest
  HugeVector<BandBlock> blocks;
  HugeVector<BlockBounds> bounds;  ///< one for each block

  /// Frees their memory: `bounds = {}` would keep it.
  void dropBounds() noexcept { bounds = HugeVector<BlockBounds>(); }
  /// The block of voxel (i, j, k), or -1.
  [[nodiscard]] std::int32_t blockAt(int i, int j, int k) const noexcept {
    const int place = (i >> 3) + table_size[0] * ((j >> 3) + table_size[1] * (k >> 3));
    return table[static_cast<std::size_t>(place)];
  }
  /// The value at an index of the image; NaN: not in the band.
  [[nodiscard]] float valueAt(int i, int j, int k) const noexcept;
  /// Distance of an inside voxel of the box to the image's border; infinite if that is not within
  /// kReach voxels.
  [[nodiscard]] double borderDistance(const std::array<int, 3>& at) const noexcept;
  /// The value of an inside voxel when the shape ends at the border, from that in an open band.
  [[nodiscard]] float closed(float value, const std::array<int, 3>& at) const noexcept {
    const double border = borderDistance(at);
    if (!is_open || !(border < kInfinity)) return value;
    const auto end = static_cast<float>(-border);
    return value > end ? value : end;  // NaN, too, becomes the border's
  }
  [[nodiscard]] static std::size_t placeOf(int i, int j, int k) noexcept {
    const int place = ((i & 7) << 6) | ((j & 7) << 3) | (k & 7);
    return static_cast<std::size_t>(place);
  }
};

/// How far each voxel center may be from the surface, judging by the mask alone. If the nearest
/// voxel of the other side is d away, the surface is at most d away, and hardly nearer than the
/// last voxel of the own side on the way there. Parts one voxel thin are held open. `spacing`: of
/// the voxels along each axis, in units of the smallest. Faces between cliffs are half-way.
[[nodiscard]] Band bandOf(const Mask& mask, const Vec3& spacing, bool is_open = false);

/// Ends the shape of an open band at the image's border.
void closeBand(Band& band, const Mask& mask);

}  // namespace palpate::vdb
