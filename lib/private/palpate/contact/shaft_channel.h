#pragma once
/// The sideways force of one tissue on a straight needle's shaft, in the channel that the needle
/// cut there.

#include "palpate/core/math.h"

namespace palpate {

/// The resistance to sideways motion, a Winkler foundation along the shaft, with its parameters at
/// the place of the shaft.
struct ChannelLaw {
  double stiffness = 0.0;  ///< [N/m^2] load per length over displacement, 0 or more
  double strength =
      kInfinity;  ///< [N/m] mean load per length at which the tissue tears; more than 0
};

/// The needle is rigid and turns about a fulcrum, the hole by which it first went in. A point of
/// the shaft at s [m] from there is pushed aside from the channel, the line along which it came
/// into the tissue: for each length ds of the shaft from s0 to s1 a spring stores stiffness |s
/// direction - channel(s)|^2 / 2 ds. The force depends on the channel only through its mean
/// direction a, weighted by s^2, so only that is stored. With the moment M = (s1^3 - s0^3) / 3 and
/// the tip at a distance L, the force on the tip is
///   stiffness M / L (a - direction), less its part along the needle.
/// For example, a needle s1 = L deep in one tissue, turned by a small angle until its tip has moved
/// by u, feels stiffness L u / 3. Length enters unstretched, along the needle as it is; length that
/// leaves takes its energy with it. Where the mean load would exceed the strength, the channel
/// gives way and then stays where it is. So it is passive: apart from those losses it is a spring.
/// The force is at most stiffness L^2 / 3 per unit of |a - direction|, which is at most 2. A value
/// type; real-time safe.
class ShaftChannel {
 public:
  /// The tissue holds the shaft from `begin` to `end` [m] from the fulcrum, and the needle lies
  /// along `direction` [-]. Returns the moment [N m] about the fulcrum that pulls the direction
  /// back, as a vector perpendicular to it: the force [N] on a tip that is L [m] away is that
  /// divided by L.
  [[nodiscard]] Vec3 step(const ChannelLaw& law, double begin, double end,
                          const Vec3& direction) noexcept;

  /// [J] Energy in a tissue of `stiffness` [N/m^2] around a needle that lies along `direction` [-].
  [[nodiscard]] double stored(double stiffness, const Vec3& direction) const noexcept {
    const Vec3 aside = direction_ - direction;
    return 0.5 * stiffness * moment_ * glm::dot(aside, aside);
  }

  /// [-] Mean direction of the channel from the fulcrum; its length is at most 1.
  [[nodiscard]] const Vec3& direction() const noexcept { return direction_; }
  /// [m^3] (end^3 - begin^3) / 3 of the last step.
  [[nodiscard]] double moment() const noexcept { return moment_; }

 private:
  Vec3 direction_{0.0, 0.0, 0.0};
  double moment_ = 0.0;
};

}  // namespace palpate
