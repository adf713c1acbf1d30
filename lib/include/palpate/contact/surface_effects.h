#pragma once
/// What a wall's material adds to the plain spring: textures and force shading.

#include "palpate/fields/field.h"
#include "palpate/materials/material.h"

namespace palpate {

/// Height [m] of the texture above the surface at `p` [m] when pressed `depth` [m] deep.
[[nodiscard]] double textureHeight(const Texture& texture, const Vec3& p, double depth) noexcept;

/// `normal` smoothed over `radius` [m]: the direction in which the field rises between points that far
/// to each side of `p` [m]. It takes values, not gradients, so that it is continuous where the gradient
/// jumps (edges between facets). `side` is +1 outside, -1 inside.
[[nodiscard]] Vec3 shadedNormal(const Field& field, double side, const Vec3& p, const Vec3& normal,
                                double radius) noexcept;

}  // namespace palpate
