#pragma once
/// Hand paths for the bench, one point a tick.

#include <functional>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::tools {

inline constexpr double kTickSeconds = 1e-3;  ///< [s] between two points of a path

/// A curve in space [m], as a function of a parameter.
using Curve = std::function<Vec3(double s)>;

/// Points along a curve; the steps between them match `speed` [m/s] to a thousandth.
class PathMaker {
 public:
  explicit PathMaker(const Vec3& start) : points_{start} {}

  /// Moves straight to `target`.
  void go(const Vec3& target, double speed);
  /// Moves along `curve` from s = `from` to `to`; first goes to the start, at the same speed.
  void follow(const Curve& curve, double from, double to, double speed);

  /// The same, but with `stride` of the parameter each tick, at whatever speed that gives.
  void play(const Curve& curve, double from, double to, double stride);

  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
  [[nodiscard]] const Vec3& at() const noexcept { return points_.back(); }
  [[nodiscard]] std::vector<Vec3> take() noexcept { return std::move(points_); }

 private:
  std::vector<Vec3> points_;
};

/// A unit vector that goes around a great circle once in 2 pi, while the circle itself turns about
/// z at a twentieth of that rate: in ten rounds it passes near most of the sphere.
[[nodiscard]] Vec3 windingDirection(double s) noexcept;

}  // namespace palpate::tools
