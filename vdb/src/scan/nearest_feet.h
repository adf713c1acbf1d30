#pragma once
/// Closest points that voxels have found, handed on to their neighbors.

#include <array>
#include <cstdint>
#include <limits>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// The way from each voxel of a block of 8^3 (in OpenVDB's order, place 64 x + 8 y + z) to its
/// closest point of a surface, by axis.
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

/// For the voxels of a block, the nearest of those closest points that they and the 26 voxels
/// around them have.
class NearestFeet {
 public:
  /// `axes`: columns, the way from a voxel to the next, in the feet's unit and frame.
  explicit NearestFeet(const Mat3& axes) noexcept;

  /// Looks at all voxels of the rows (8 x + y) that `rows` has a bit for. `around`: the feet of the
  /// block and of those about it, 9 dx + 3 dy + dz from -1 on; null: there is none.
  void find(const std::array<const Feet*, 27>& around, std::uint64_t rows) noexcept;

  /// What find() found: the square of the distance; Feet::kNone if none of them has a point.
  [[nodiscard]] float square(std::size_t place) const noexcept { return square_[place]; }
  /// The way to that point. Only where there is one.
  [[nodiscard]] Vec3 foot(std::size_t place) const noexcept;
  /// Which of the voxels around, 9 dx + 3 dy + dz from -1 on, has it.
  [[nodiscard]] int which(std::size_t place) const noexcept {
    return static_cast<int>(which_[place]);
  }

 private:
  static constexpr int kSide = 10;
  static constexpr int kRow = 16;   ///< floats of a row, of which kSide count
  static constexpr int kFirst = 4;  ///< place of voxel 0 in its row

  [[nodiscard]] static constexpr int at(int x, int y, int z) noexcept {
    return ((x + 1) * kSide + y + 1) * kRow + z + kFirst;
  }

  void gather(const std::array<const Feet*, 27>& around) noexcept;

  std::array<std::array<float, 3>, 27> steps_{};  ///< to the voxels around
  std::array<int, 27> places_{};                  ///< of them, from the voxel's on
  alignas(32) std::array<std::array<float, std::size_t{kSide} * kSide * kRow>, 3> feet_;
  alignas(32) std::array<float, 512> square_;
  alignas(32) std::array<float, 512> which_;  ///< of the 27
};

}  // namespace palpate::vdb
