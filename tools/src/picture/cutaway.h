#pragma once
/// A scene in space, shaded, with what is before a plane cut away.

#include "palpate/core/progress.h"
#include "picture/ray_march.h"

namespace palpate::tools {

/// Looks at the cut face of `plane` from its front, right and above.
[[nodiscard]] Camera cameraOn(const CutPlane& plane);

/// Moves and scales `camera` so that all of the scene that is not cut away, and all of `points`,
/// fill `width` x `height` pixels.
void fitCamera(Camera& camera, const SpaceScene& space, const std::vector<Vec3>& points, int width,
               int height);

/// On all cores. The cut face is flat, everything else shaded by its exact normal.
[[nodiscard]] Raster drawSpace(const SpaceScene& space, const Camera& camera,
                               const Progress& progress);

}  // namespace palpate::tools
