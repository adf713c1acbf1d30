#pragma once
/// The scene in space with its front half cut away, shaded.

#include "palpate/core/progress.h"
#include "palpate/scene/scene.h"
#include "picture/canvas.h"
#include "picture/cut_plane.h"
#include "picture/paint.h"

namespace palpate::tools {

/// Parallel projection, looking at the cut face from its front, right and above.
struct Camera {
  Vec3 center{0.0};  ///< [m] in the middle of the picture
  Vec3 right{1.0, 0.0, 0.0};
  Vec3 up{0.0, 0.0, 1.0};
  Vec3 toward{0.0, -1.0, 0.0};  ///< at the viewer
  double step = 1.0;            ///< [m] a pixel
  int width = 0;
  int height = 0;

  [[nodiscard]] Pixel pixel(const Vec3& p) const {
    const Vec3 d = p - center;
    return {0.5 * width + glm::dot(d, right) / step, 0.5 * height - glm::dot(d, up) / step};
  }
};

/// A camera that sees all of the scene within `box` that is behind the plane, and all of `points`.
[[nodiscard]] Camera cameraFor(const Scene& scene, const CutPlane& plane, const Box3& box,
                               const std::vector<Vec3>& points, int width, int height);

/// What is behind the plane within `box`: the cut face flat, everything else by Lambert's law.
[[nodiscard]] Raster drawCutaway(const Scene& scene, const CutPlane& plane, const Box3& box,
                                 const Camera& camera, const Paint& paint,
                                 const Progress& progress);

}  // namespace palpate::tools
