#pragma once
/// The values that a grid of a field should have: distance, normal and curvature near the surface.

#include <optional>

#include "palpate/fields/field.h"

namespace palpate::tools {

struct TruePoint {
  double value = 0.0;          ///< [m] distance, negative inside
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit
  /// [1/m] mean of the principal curvatures of the parallel surface through the point; positive
  /// where convex.
  double curvature = 0.0;
};

/// For a field with a distance (exact, or a bound) the field's own value, gradient and Hessian; for
/// an implicit field the exact distance, by projection onto its zero set. Keeps the field alive.
class Truth {
 public:
  explicit Truth(FieldPtr field)
      : field_(std::move(field)), projects_(field_->metric() == Metric::kImplicit) {}

  [[nodiscard]] const Field& field() const noexcept { return *field_; }
  [[nodiscard]] bool projects() const noexcept { return projects_; }

  /// Nothing where the truth is not known: at a kink of an implicit field, or too far from its
  /// surface.
  [[nodiscard]] std::optional<TruePoint> at(const Vec3& p) const noexcept;

  /// The surface point near `p`, up to rounding; nothing if it is not found.
  [[nodiscard]] std::optional<Vec3> onSurface(const Vec3& p) const noexcept;

 private:
  FieldPtr field_;
  bool projects_;
};

/// [1/m] Mean curvature of the level surface through the point.
[[nodiscard]] double meanCurvature(const FieldJet& jet) noexcept;

/// [voxels] how far a sampler's stencil, including the voxels that its coefficients are computed
/// from, reaches along an axis.
inline constexpr double kStencilReach = 4.0;
/// [voxels] Radius of curvature below which a surface counts as an edge: no grid of that voxel size
/// can hold it.
inline constexpr double kTightestBend = 1.5;

/// False if the field has an edge, a medial axis or a tight bend within reach of the stencil. The
/// test follows the lines from `p` to the 26 corners, edge middles and face middles of a cube that
/// reaches kStencilReach voxels of size `voxel` [m] to each side. It fails if on some segment of at
/// most half a voxel the gradient turns by more than a degree, and by more than on a bend of
/// kTightestBend.
[[nodiscard]] bool isSmoothAround(const Field& field, const Vec3& p, double voxel) noexcept;

}  // namespace palpate::tools
