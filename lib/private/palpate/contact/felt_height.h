#pragma once
/// Heights that are added to a wall's surface: bumps of a texture, and the difference to a surface
/// smoothed by shading. Both are functions of the place alone, so that their force has a potential.

#include <array>

#include "palpate/fields/field.h"
#include "palpate/materials/material.h"

namespace palpate {

struct FeltHeight {
  double value = 0.0;            ///< [m]
  Vec3 gradient{0.0, 0.0, 0.0};  ///< [-]
};

/// Height of the texture at `p` [m].
[[nodiscard]] FeltHeight textureHeight(const Texture& texture, const Vec3& p) noexcept;

/// [m] The depth down to which the texture counts in full. If it did so deeper down, it would be
/// stiffer along the wall than the wall itself is. At least twice its amplitude; infinite without a
/// texture.
[[nodiscard]] double textureReach(const Texture& texture) noexcept;

/// A field smoothed over a radius: the quadratic B-spline of its distances at the nodes of a
/// lattice that is fixed in space, with a spacing of two thirds of the radius. So the value is
/// continuous also where the field has edges, and the gradient is exactly its derivative,
/// continuous too. Caches the nodes around the last place. Real-time safe.
class SmoothedField {
 public:
  /// The smoothed field at `p` [m], within reach of the surface; `radius` [m] more than 0.
  [[nodiscard]] FeltHeight at(const Field& field, double radius, const Vec3& p) noexcept;

 private:
  void look(const Field& field, double spacing) noexcept;

  const Field* field_ = nullptr;
  double spacing_ = 0.0;
  std::array<double, 3> node_{};       ///< index of the middle node along each axis
  std::array<double, 27> distance_{};  ///< [m]
};

}  // namespace palpate
