#pragma once
// The nearest point of a polyhedron, exact: one plane after another, after Seidel (1991).

#include <array>
#include <cmath>
#include <span>

#include "palpate/core/math.h"

namespace palpate::testing {

/// Allowed: normal . p + gap >= 0; the normal is a unit vector.
struct HalfSpaceBound {
  Vec3 normal{0.0, 0.0, 1.0};
  double gap = 0.0;  ///< [m] value at p = 0
};

struct NearestOfPlanes {
  Vec3 point{0.0, 0.0, 0.0};
  /// The planes on which it lies; the first `active_count` entries count
  std::array<int, 3> active{};
  int active_count = 0;
  bool is_allowed = true;  ///< false: the planes leave no room, or rounding let one be violated
};

class PlaneProblem {
 public:
  explicit PlaneProblem(std::span<const HalfSpaceBound> planes) : planes_(planes) {}

  /// min |p - goal|^2.
  [[nodiscard]] NearestOfPlanes nearestTo(const Vec3& goal) const {
    slack_ = 1e-13 * glm::length(goal) + 1e-19;
    NearestOfPlanes best{goal};
    const int count = static_cast<int>(planes_.size());
    for (int i = 0; i < count; ++i) {
      if (at(i, best.point) < -slack_) best = onPlane(i, goal);
    }
    for (int i = 0; i < count; ++i) best.is_allowed &= at(i, best.point) >= -1e3 * slack_ - 1e-15;
    return best;
  }

 private:
  /// Planes whose normals differ by less count as parallel.
  static constexpr double kParallel = 1e-11;

  [[nodiscard]] double at(int i, const Vec3& p) const {
    const HalfSpaceBound& plane = planes_[static_cast<std::size_t>(i)];
    return glm::dot(plane.normal, p) + plane.gap;
  }
  [[nodiscard]] const Vec3& normal(int i) const {
    return planes_[static_cast<std::size_t>(i)].normal;
  }

  /// The best point on plane `i` that the planes before it allow.
  [[nodiscard]] NearestOfPlanes onPlane(int i, const Vec3& goal) const {
    const Vec3 foot = goal - at(i, goal) * normal(i);
    NearestOfPlanes best{foot, {i}, 1};
    for (int j = 0; j < i; ++j) {
      if (at(j, best.point) >= -slack_) continue;
      const Vec3 along = normal(j) - glm::dot(normal(i), normal(j)) * normal(i);
      const double slope = glm::length(along);
      if (slope < kParallel) continue;
      const Vec3 on_both = foot - (at(j, foot) / (slope * slope)) * along;
      best = onLine(i, j, on_both, glm::cross(normal(i), normal(j)) / slope);
    }
    return best;
  }

  /// The allowed point of a line nearest to `foot`, which is the foot of the goal on this line.
  [[nodiscard]] NearestOfPlanes onLine(int i, int j, const Vec3& foot, const Vec3& way) const {
    double low = -kInfinity;
    double high = kInfinity;
    int low_plane = -1;
    int high_plane = -1;
    for (int k = 0; k < j; ++k) {
      const double rise = glm::dot(normal(k), way);
      if (std::fabs(rise) < kParallel) continue;
      const double zero = -at(k, foot) / rise;
      if (rise > 0.0 && zero > low) {
        low = zero;
        low_plane = k;
      } else if (rise < 0.0 && zero < high) {
        high = zero;
        high_plane = k;
      }
    }
    if (low > 0.0 && low >= high) return {foot + 0.5 * (low + high) * way, {i, j, low_plane}, 3};
    if (low > 0.0) return {foot + low * way, {i, j, low_plane}, 3};
    if (high < 0.0) return {foot + high * way, {i, j, high_plane}, 3};
    return {foot, {i, j}, 2};
  }

  std::span<const HalfSpaceBound> planes_;
  mutable double slack_ = 0.0;
};

}  // namespace palpate::testing
