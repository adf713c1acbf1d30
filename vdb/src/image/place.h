#pragma once
/// The place of voxels in space.

#include <array>
#include <string>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// Voxel (i, j, k) has its center at axes (i, j, k) + origin.
struct Place {
  Mat3 axes{1.0};
  Vec3 origin{0.0, 0.0, 0.0};
};

/// x and y negated: converts LPS to RAS and back.
[[nodiscard]] Place turned(const Place& place) noexcept;

[[nodiscard]] Place scaled(const Place& place, double factor) noexcept;

/// False if a number is not finite or the voxels have no volume.
[[nodiscard]] bool isUsable(const Place& place) noexcept;

/// Axis codes, "RAS".
[[nodiscard]] std::string orientationCodes(const Mat3& axes);

/// Largest distance, over the corners of the image, between their places by `a` and by `b`, in
/// voxels of `a`.
[[nodiscard]] double disagreement(const Place& a, const Place& b, const std::array<int, 3>& size);

/// "4 x 5 x 6"
template <typename Sizes>
std::string shapeText(const Sizes& sizes) {
  std::string text;
  for (const auto size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

}  // namespace palpate::vdb
