#pragma once
/// Vectors, boxes and rigid motions: the few geometric value types that everything shares.

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "palpate/export.h"

/// Palpate: fields, materials, scenes with regions and ports, and the renderers that turn the
/// motion of a hand into forces. SI units; forces act on the hand.
namespace palpate {

/// Point, displacement or force; the comment beside each use names unit and frame.
using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;  ///< Column major, as GLM has it: m[column][row].

/// Stands for "no limit" in lengths, forces and bounds.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// True if no component is NaN or infinite.
[[nodiscard]] inline bool isFinite(const Vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// `v` scaled to length 1, or `fallback` where `v` has no direction.
[[nodiscard]] inline Vec3 unitOr(const Vec3& v, const Vec3& fallback) noexcept {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : fallback;
}

/// The matrix a b^T.
[[nodiscard]] inline Mat3 outer(const Vec3& a, const Vec3& b) noexcept {
  return Mat3(a * b.x, a * b.y, a * b.z);
}

/// Axis-aligned box [m]. A default box is empty; a box may be infinite in any direction.
struct PALPATE_EXPORT Box3 {
  Vec3 lo{kInfinity, kInfinity, kInfinity};     ///< [m] lower corner
  Vec3 hi{-kInfinity, -kInfinity, -kInfinity};  ///< [m] upper corner

  /// All of space.
  [[nodiscard]] static Box3 everything() noexcept {
    return {Vec3(-kInfinity, -kInfinity, -kInfinity), Vec3(kInfinity, kInfinity, kInfinity)};
  }
  /// True if the box has no point, as by default; a NaN in a corner counts as empty.
  [[nodiscard]] bool isEmpty() const noexcept {
    return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z);
  }
  /// True if the box has points and none of its sides is at infinity.
  [[nodiscard]] bool isBounded() const noexcept {
    return !isEmpty() && palpate::isFinite(lo) && palpate::isFinite(hi);
  }
  /// [m] The middle of a bounded box.
  [[nodiscard]] Vec3 center() const noexcept { return 0.5 * (lo + hi); }
  /// [m] The lengths of the edges; negative if the box is empty.
  [[nodiscard]] Vec3 size() const noexcept { return hi - lo; }
  /// Whether `p` [m] is in the box or on its boundary.
  [[nodiscard]] bool contains(const Vec3& p) const noexcept {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
  }
  /// Grows the box just enough to contain `p` [m]; a coordinate that is NaN is ignored.
  void include(const Vec3& p) noexcept {
    for (int i = 0; i < 3; ++i) {
      lo[i] = std::fmin(lo[i], p[i]);
      hi[i] = std::fmax(hi[i], p[i]);
    }
  }
  /// The smallest box around both; a default box adds nothing.
  [[nodiscard]] Box3 unitedWith(const Box3& other) const noexcept;
  /// The common part of both; empty if there is none.
  [[nodiscard]] Box3 intersectedWith(const Box3& other) const noexcept;
  [[nodiscard]] Box3 grownBy(double margin) const noexcept;  ///< margin [m]; empty stays empty
  /// Distance [m] from `p` to the box, 0 inside.
  [[nodiscard]] double distanceTo(const Vec3& p) const noexcept;
};

/// Rigid motion x -> rotation * x + translation. `X_AB` maps coordinates in B to coordinates in A.
struct PALPATE_EXPORT Pose {
  Mat3 rotation{1.0};               ///< [-] orthonormal, determinant +1
  Vec3 translation{0.0, 0.0, 0.0};  ///< [m]

  /// Moves a point [m].
  [[nodiscard]] Vec3 apply(const Vec3& p) const noexcept { return rotation * p + translation; }
  /// Moves a point [m] back: the inverse of apply().
  [[nodiscard]] Vec3 applyInverse(const Vec3& p) const noexcept {
    return glm::transpose(rotation) * (p - translation);
  }
  /// Turns a direction or a displacement, which the translation does not change.
  [[nodiscard]] Vec3 rotate(const Vec3& v) const noexcept { return rotation * v; }
  /// The motion `first`, then this one.
  [[nodiscard]] Pose after(const Pose& first) const noexcept {
    return {rotation * first.rotation, rotation * first.translation + translation};
  }
  /// Box around the moved `box`.
  [[nodiscard]] Box3 apply(const Box3& box) const noexcept;
};

/// Rotation about `axis` (any length but zero) by `radians`.
[[nodiscard]] PALPATE_EXPORT Mat3 rotationAbout(const Vec3& axis, double radians) noexcept;

}  // namespace palpate
