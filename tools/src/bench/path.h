#pragma once
/// Hand paths for the bench, one point a tick.

#include <functional>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::tools {

inline constexpr double kTickSeconds = 1e-3;  ///< [s] between two points of a path

/// A curve in space [m] by a parameter.
using Curve = std::function<Vec3(double s)>;

/// Points along a curve, `speed` [m/s] apart to a thousandth.
class PathMaker {
 public:
  explicit PathMaker(const Vec3& start) : points_{start} {}

  /// Straight to `target`.
  void go(const Vec3& target, double speed);
  /// Along `curve` from s = `from` to `to`; goes to its start first, at the same speed.
  void follow(const Curve& curve, double from, double to, double speed);

  /// The same, but `stride` of the parameter a tick, at whatever speed that is.
  void play(const Curve& curve, double from, double to, double stride);

  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
  [[nodiscard]] const Vec3& at() const noexcept { return points_.back(); }
  [[nodiscard]] std::vector<Vec3> take() noexcept { return std::move(points_); }

 private:
  std::vector<Vec3> points_;
};

/// A unit vector that goes round a great circle once in 2 pi, while the circle itself turns about z
/// a twentieth as fast: in ten rounds it comes by most of the sphere.
[[nodiscard]] Vec3 windingDirection(double s) noexcept;

}  // namespace palpate::tools
