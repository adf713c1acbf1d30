#pragma once
/// The closest point of a field's zero set, from a start nearby.

#include <optional>

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// Newton's method on the field's quadratic model. Each iteration finds the closest point of the
/// surface that value, gradient and Hessian at the present place describe, without further queries
/// of the field, and goes there. The error after a step is of third order in its length, so that
/// from a start nearby one query of the field is mostly enough.
class ClosestPoint {
 public:
  /// `voxel` [m]: results are accurate to some 1e-7 of it where the radius of curvature is a voxel
  /// or more.
  ClosestPoint(const Field& field, double voxel) noexcept : field_(field), voxel_(voxel) {}

  /// [m] From `start`, which is within two voxels or so of the surface. Nothing where the iteration
  /// fails: at a kink of the field, or where its gradient vanishes.
  [[nodiscard]] std::optional<Vec3> of(const Vec3& p, const Vec3& start) const noexcept;

  /// The same, with the field's jet `at_start` already known.
  [[nodiscard]] std::optional<Vec3> from(const Vec3& p, const Vec3& start,
                                         const FieldJet& at_start) const noexcept;

  /// [m] The same, by small steps along the surface that only ever come nearer to `p`. Starts at
  /// `foot`, a point on the surface, and also crosses a kink of the field. At an edge the result is
  /// off along the edge by some hundredths of a voxel.
  [[nodiscard]] Vec3 creptTo(const Vec3& p, const Vec3& foot) const noexcept;

  /// Some point of the surface beside `start`, found by descent along the gradient. Nothing if
  /// there is none within two voxels.
  [[nodiscard]] std::optional<Vec3> onto(const Vec3& start) const noexcept;

 private:
  const Field& field_;
  double voxel_;  ///< [m]
};

}  // namespace palpate::vdb
