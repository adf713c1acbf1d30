#pragma once
/// The viewpoint of a picture of a scene in space.

#include <algorithm>
#include <cmath>

#include "palpate/core/math.h"
#include "picture/canvas.h"

namespace palpate::tools {

/// Parallel projection.
struct Camera {
  Vec3 center{0.0};  ///< [m] at the center of the picture
  Vec3 right{1.0, 0.0, 0.0};
  Vec3 up{0.0, 0.0, 1.0};
  Vec3 toward{0.0, -1.0, 0.0};  ///< towards the viewer
  double step = 1.0;            ///< [m] size of a pixel
  int width = 0;
  int height = 0;

  [[nodiscard]] Pixel pixel(const Vec3& p) const {
    const Vec3 d = p - center;
    return {0.5 * width + glm::dot(d, right) / step, 0.5 * height - glm::dot(d, up) / step};
  }
  /// A point [m] that is seen at (x, y).
  [[nodiscard]] Vec3 world(double x, double y) const {
    return center + right * ((x - 0.5 * width) * step) + up * ((0.5 * height - y) * step);
  }
};

/// A camera that looks from the direction `toward` (of any finite length except zero), with `up` as
/// upright as possible; if `up` is parallel to `toward`, with y upright.
[[nodiscard]] inline Camera cameraFrom(const Vec3& toward, const Vec3& up = {0.0, 0.0, 1.0}) {
  Camera camera;
  // Scaled first, because the square of a very long or short vector leaves the range of doubles.
  const double most = std::max({std::abs(toward.x), std::abs(toward.y), std::abs(toward.z)});
  camera.toward = glm::normalize(toward / most);
  const Vec3 right = glm::cross(up, camera.toward);
  camera.right = glm::length(right) > 1e-6
                     ? glm::normalize(right)
                     : glm::normalize(glm::cross(Vec3(0.0, 1.0, 0.0), camera.toward));
  camera.up = glm::cross(camera.toward, camera.right);
  return camera;
}

}  // namespace palpate::tools
