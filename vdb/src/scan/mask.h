#pragma once
/// The voxels of a shape, with its connected components and cavities.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// Inside or outside for each voxel of a box of an image, with a frame of outside voxels one thick,
/// so that every voxel of the box has neighbors.
///
/// Inside voxels are connected across faces, outside voxels across faces and edges.
struct Mask {
  std::array<int, 3> first{};        ///< image index of the box's first voxel
  std::array<int, 3> box{};          ///< voxels of the box along i, j, k
  std::vector<std::uint8_t> inside;  ///< 0 or 1; (box[0] + 2) (box[1] + 2) (box[2] + 2), i fastest

  [[nodiscard]] std::array<std::ptrdiff_t, 3> strides() const noexcept {
    return {1, box[0] + 2, static_cast<std::ptrdiff_t>(box[0] + 2) * (box[1] + 2)};
  }
  /// Index into `inside` of box voxel (i, j, k); each coordinate may be from -1 to box[a], both in
  /// the frame.
  [[nodiscard]] std::ptrdiff_t at(int i, int j, int k) const noexcept {
    const auto s = strides();
    return (i + 1) + s[1] * (j + 1) + s[2] * (k + 1);
  }
  /// Whether the mask holds the voxel at an index of the image.
  [[nodiscard]] bool holds(int i, int j, int k) const noexcept {
    const std::array<int, 3> local = {i - first[0], j - first[1], k - first[2]};
    for (std::size_t a = 0; a < 3; ++a) {
      if (local[a] < 0 || local[a] >= box[a]) return false;
    }
    return inside[static_cast<std::size_t>(at(local[0], local[1], local[2]))] != 0;
  }
};

/// The voxels whose value passes `test`, in the smallest box that holds them and `margin` voxels
/// around, clipped to the image. The box is empty if there are none.
[[nodiscard]] Mask maskOf(const Image& image, const std::function<bool(float)>& test, int margin);

/// Keeps only the largest component (the first in voxel order if two are equal); returns how many
/// components there were.
std::size_t keepLargestPiece(Mask& mask);

/// Fills all outside voxels that no path of outside voxels connects to the border of the box;
/// spaces connected to the border by a passage stay open. Returns how many voxels were filled.
std::size_t fillCavities(Mask& mask);

}  // namespace palpate::vdb
