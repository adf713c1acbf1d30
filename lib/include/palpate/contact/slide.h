#pragma once
/// Newton's step for a proxy that slides on curved walls, and the way back onto them.

#include <array>
#include <span>

#include "palpate/fields/field.h"

namespace palpate {

/// A wall that holds the proxy.
struct HeldWall {
  const Field* field = nullptr;
  double side = 1.0;        ///< +1: the proxy is where S > 0
  double tolerance = 0.0;   ///< [m] times the field's Lipschitz bound: how near is on the wall
  FieldJet jet{};           ///< at the proxy
  Vec3 normal{0.0};         ///< [-] side * gradient / |gradient|
  double multiplier = 0.0;  ///< [m] of PlaneSolution
  Vec3 probe{0.0, 0.0,
             0.0};  ///< [-] unit: this is the wall met that way from a crease of the field; zero:
                    ///< the field is smooth here
  double reach = 0.0;  ///< [m] how far along `probe` it is asked for
};

struct SlideStep {
  Vec3 step{0.0, 0.0, 0.0};  ///< [m] tangential
  bool is_saddle = false;    ///< the proxy rests where it could still come closer (second order)
  Vec3 downhill{0.0, 0.0, 0.0};  ///< [-] then: a direction in which it comes closer
};

/// The part of `v` along all walls.
[[nodiscard]] Vec3 tangentialPart(const Vec3& v, std::span<const HeldWall> walls) noexcept;

/// Solves (I - sum lambda_i H_i / |grad S_i|) y = pull in the tangent space of one to three walls, with
/// the eigenvalues' magnitudes (at least 0.02) so that y comes closer, and the turn of the normal
/// over y at most half a radian. `pull` [m] is tangential. Source: the second-order condition of
/// min |x - P|^2 on S = 0.
[[nodiscard]] SlideStep slideStep(const Vec3& pull, std::span<const HeldWall> walls) noexcept;

/// The chain rule through a proxy at rest: the gradient by the hand's position of what has `gradient` by the
/// proxy's. The proxy follows the hand by (I - sum lambda_i H_i / |grad S_i|)^-1 along the walls, and not at
/// all across them; near the hand's focal points the inverse is held to 50.
[[nodiscard]] Vec3 gradientByHand(const Vec3& gradient, std::span<const HeldWall> walls) noexcept;

/// Cheap test before slideStep() at rest: false if no direction along the walls can have a negative
/// curvature (the walls bend too little for the depth).
[[nodiscard]] bool mayBeSaddle(std::span<const HeldWall> walls) noexcept;

/// Gauss-Newton onto all walls from `x` [m]; false if it did not come within the tolerances. `began_free`
/// tells whether `x` was on the free side of all of them.
[[nodiscard]] bool pullBack(Vec3& x, std::span<const HeldWall> walls, bool& began_free) noexcept;

}  // namespace palpate
