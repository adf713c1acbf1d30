#pragma once
/// The force on a hand that rests at points of a plane: the field of forces in a picture.

#include <vector>

#include "palpate/core/progress.h"
#include "picture/cut_plane.h"

namespace palpate::tools {

struct RestForce {
  Vec3 at{0.0, 0.0, 0.0};     ///< [m] of the hand
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] on the hand
};

/// The part of `plane` within `box` is divided into squares: `count` along its longer side, and as
/// many as fit along the other. For the middle of each square: the force, if any, on a hand that
/// was led there straight from the nearest place outside and has come to rest. Uses the scene's
/// renderer, and all cores.
[[nodiscard]] std::vector<RestForce> restForces(const Scene& scene, const CutPlane& plane,
                                                const Box3& box, int count,
                                                const Progress& progress);

/// [m] Side length of those squares.
[[nodiscard]] double restSpacing(const CutPlane& plane, const Box3& box, int count);

}  // namespace palpate::tools
