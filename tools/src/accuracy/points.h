#pragma once
/// The places where a grid is compared with the truth: random points near the surface, and strokes
/// along it.

#include <cstdint>
#include <vector>

#include "accuracy/truth.h"
#include "palpate/core/progress.h"

namespace palpate::tools {

struct JudgedPoint {
  Vec3 at{0.0, 0.0, 0.0};  ///< [m]
  TruePoint truth;
  bool smooth = true;  ///< by isSmoothAround()
};

struct PointSet {
  std::vector<JudgedPoint> points;
  /// Points that were near enough, but have no known truth; not among `points`
  std::size_t without_truth = 0;
};

/// `count` points, evenly distributed over the space whose true distance to the surface is at most
/// `band` [m]. The same arguments give the same points, on every machine with the same rounding.
/// `voxel` [m] is used for JudgedPoint::smooth. The field must be bounded.
/// @throws Error: kInput if it has no surface, kCancelled.
[[nodiscard]] PointSet pointsNear(const Truth& truth, double band, std::size_t count, double voxel,
                                  const Progress& progress = {});

/// Points on the surface, `step` [m] apart along a line that is as straight as the surface allows.
struct Stroke {
  std::vector<JudgedPoint> points;
};

/// Strokes of `length` points each, starting at the first points of `from`, in random directions; a
/// stroke ends early where the surface cannot be followed.
[[nodiscard]] std::vector<Stroke> strokesAlong(const Truth& truth, const PointSet& from,
                                               std::size_t strokes, std::size_t length, double step,
                                               double voxel, const Progress& progress = {});

}  // namespace palpate::tools
