#pragma once
/// What a hand would feel that rests on a plane: a picture's field of forces.

#include <vector>

#include "palpate/core/progress.h"
#include "picture/cut_plane.h"

namespace palpate::tools {

struct RestForce {
  Vec3 at{0.0, 0.0, 0.0};     ///< [m] the hand
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] on it
};

/// At the middles of `count` squares along the longer side of the part of `plane` that lies within
/// `box`, and as many as fit along the other: the force, where there is any, on a hand that was led
/// there from the nearest place outside, straight, and that has come to rest. By the renderer that
/// the scene asks for. On all cores.
[[nodiscard]] std::vector<RestForce> restForces(const Scene& scene, const CutPlane& plane,
                                                const Box3& box, int count,
                                                const Progress& progress);

/// [m] The side of those squares.
[[nodiscard]] double restSpacing(const CutPlane& plane, const Box3& box, int count);

}  // namespace palpate::tools
