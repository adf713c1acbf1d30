#pragma once
/// Passes closest points that voxels have found on to their neighbors.

#include <array>
#include <cstdint>
#include <limits>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// The vector from each voxel of a block of 8^3 (in OpenVDB's order, place 64 x + 8 y + z) to its
/// closest point of a surface, axis by axis.
struct Feet {
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  alignas(32) std::array<std::array<float, 512>, 3> from;

  void clear() noexcept {
    for (auto& axis : from) axis.fill(kNone);
  }
  void set(std::size_t place, const Vec3& foot) noexcept {
    for (int a = 0; a < 3; ++a) {
      from[static_cast<std::size_t>(a)][place] = static_cast<float>(foot[a]);
    }
  }
  [[nodiscard]] bool has(std::size_t place) const noexcept { return from[0][place] != kNone; }
  [[nodiscard]] Vec3 at(std::size_t place) const noexcept {
    return {from[0][place], from[1][place], from[2][place]};
  }
};

/// For each voxel of a block, the nearest of the closest points known to it and to the 26 voxels
/// around it.
class NearestFeet {
 public:
  /// `axes`: columns, the vector from a voxel to the next, in the feet's unit and frame.
  explicit NearestFeet(const Mat3& axes) noexcept;

  /// Searches all voxels of the rows (8 x + y) whose bit in `rows` is set. `around`: the feet of
  /// the block and of the blocks around it, index 9 dx + 3 dy + dz counted from -1; null: there is
  /// none.
  void find(const std::array<const Feet*, 27>& around, std::uint64_t rows) noexcept;

  /// The squared distance that find() found; Feet::kNone if no point is known.
  [[nodiscard]] float square(std::size_t place) const noexcept { return square_[place]; }
  /// The vector to that point. Valid only if there is one.
  [[nodiscard]] Vec3 foot(std::size_t place) const noexcept;
  /// The voxel that knows it, among those around: 9 dx + 3 dy + dz counted from -1.
  [[nodiscard]] int which(std::size_t place) const noexcept {
    return static_cast<int>(which_[place]);
  }

 private:
  static constexpr int kSide = 10;
  static constexpr int kRow = 16;   ///< floats of a row, of which kSide are used
  static constexpr int kFirst = 4;  ///< place of voxel 0 in its row

  [[nodiscard]] static constexpr int at(int x, int y, int z) noexcept {
    return ((x + 1) * kSide + y + 1) * kRow + z + kFirst;
  }

  void gather(const std::array<const Feet*, 27>& around) noexcept;

  std::array<std::array<float, 3>, 27> steps_{};  ///< vectors to the voxels around
  std::array<int, 27> places_{};                  ///< their indices, relative to the voxel's
  alignas(32) std::array<std::array<float, std::size_t{kSide} * kSide * kRow>, 3> feet_;
  alignas(32) std::array<float, 512> square_;
  alignas(32) std::array<float, 512> which_;  ///< among the 27
};

}  // namespace palpate::vdb
