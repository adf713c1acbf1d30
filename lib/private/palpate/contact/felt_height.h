#pragma once
/// Heights at which a wall is felt above where it is: bumps of a texture, and a surface smoothed by
/// shading. Both are functions of the place alone, so that what is felt of them has a potential.

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

/// [m] The depth down to which the texture is felt in full: deeper, it would be stiffer along the
/// wall than the wall is. At least twice its amplitude; infinite for no texture.
[[nodiscard]] double textureReach(const Texture& texture) noexcept;

/// A field smoothed over a radius: the quadratic B-spline of its distances at the nodes of a
/// lattice that is fixed in space, two thirds of the radius wide. So value and gradient are
/// continuous wherever the field has edges, and are each other's. Keeps the nodes around the last
/// place. Real-time safe.
class SmoothedField {
 public:
  /// At `p` [m] within reach of the surface; `radius` [m] more than 0.
  [[nodiscard]] FeltHeight at(const Field& field, double radius, const Vec3& p) noexcept;

 private:
  void look(const Field& field, double spacing) noexcept;

  const Field* field_ = nullptr;
  double spacing_ = 0.0;
  std::array<double, 3> node_{};       ///< number of the middle one along each axis
  std::array<double, 27> distance_{};  ///< [m]
};

}  // namespace palpate
