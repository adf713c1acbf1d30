#pragma once
/// The closest point of a field's zero set, from a start nearby.

#include <optional>

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// Newton's method on the field's quadratic model: at each place the closest point of the surface
/// that value, gradient and Hessian there describe is found, which takes no more of the field, and
/// is the next place. What is left after a step goes with its cube, so that from a start nearby one
/// look at the field is mostly enough.
class ClosestPoint {
 public:
  /// `voxel` [m]: results are right to some 1e-7 of it where the surface bends over a voxel and
  /// more.
  ClosestPoint(const Field& field, double voxel) noexcept : field_(field), voxel_(voxel) {}

  /// From `start`, which is within two voxels or so of the surface. Nothing where that leads
  /// nowhere: at a kink of the field, or where its gradient vanishes. [m]
  [[nodiscard]] std::optional<Vec3> of(const Vec3& p, const Vec3& start) const noexcept;

  /// The same, with the field's jet `at_start`.
  [[nodiscard]] std::optional<Vec3> from(const Vec3& p, const Vec3& start,
                                         const FieldJet& at_start) const noexcept;

  /// The same, by small steps along the surface that only ever come nearer; from a point on it,
  /// also over a kink of the field. What it finds at an edge is off along it by some hundredths of
  /// a voxel. [m]
  [[nodiscard]] Vec3 creptTo(const Vec3& p, const Vec3& foot) const noexcept;

  /// Some point of the surface beside `start`: down along the gradient. Nothing if that leads
  /// nowhere within two voxels.
  [[nodiscard]] std::optional<Vec3> onto(const Vec3& start) const noexcept;

 private:
  const Field& field_;
  double voxel_;  ///< [m]
};

}  // namespace palpate::vdb
