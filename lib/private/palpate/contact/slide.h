#pragma once
/// The walls that hold a proxy at rest, and how it slides along them when the hand moves.

#include <span>

#include "palpate/fields/field.h"

namespace palpate {

/// A wall that holds the proxy.
struct HeldWall {
  const Field* field = nullptr;
  double side = 1.0;        ///< +1: the proxy is where S > 0
  FieldJet jet{};           ///< at the proxy
  Vec3 normal{0.0};         ///< [-] side * gradient / |gradient|
  double multiplier = 0.0;  ///< [m] as in PlaneSolution
};

/// The part of `v` perpendicular to all `normals` (unit), ...
[[nodiscard]] Vec3 partAcross(const Vec3& v, std::span<const Vec3> normals) noexcept;
/// ... and the part along all walls.
[[nodiscard]] Vec3 tangentialPart(const Vec3& v, std::span<const HeldWall> walls) noexcept;

/// The chain rule through a proxy at rest: turns `gradient`, by the proxy's position, into the
/// gradient by the hand's position. The proxy follows the hand by (I - sum lambda_i H_i / |grad
/// S_i|)^-1 along the walls, and not at all across them; near the hand's focal points the inverse
/// is limited to 1000. Source: the derivative of the second-order condition of min |x - P|^2 on S =
/// 0.
[[nodiscard]] Vec3 gradientByHand(const Vec3& gradient, std::span<const HeldWall> walls) noexcept;

}  // namespace palpate
