#pragma once
/// A shaded view of a scene in space, with the part in front of a plane cut away.

#include "palpate/core/progress.h"
#include "picture/ray_march.h"

namespace palpate::tools {

/// A camera that looks at the cut face of `plane` from its front, right and above.
[[nodiscard]] Camera cameraOn(const CutPlane& plane);

/// Moves and scales `camera` so that the part of the scene that is not cut away, and all of
/// `points`, fill `width` x `height` pixels.
void fitCamera(Camera& camera, const SpaceScene& space, const std::vector<Vec3>& points, int width,
               int height);

/// Draws on all cores. The cut face is drawn flat, everything else is shaded by its exact normal.
[[nodiscard]] Raster drawSpace(const SpaceScene& space, const Camera& camera,
                               const Progress& progress);

}  // namespace palpate::tools
