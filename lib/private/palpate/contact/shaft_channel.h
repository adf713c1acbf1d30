#pragma once
/// How one tissue holds a straight needle's shaft sideways, in the channel that it cut there.

#include "palpate/core/math.h"

namespace palpate {

/// Against sideways motion: a Winkler foundation along the shaft, as it is where the shaft is.
struct ChannelLaw {
  double stiffness = 0.0;  ///< [N/m^2] load per length over displacement, 0 or more
  double strength =
      kInfinity;  ///< [N/m] mean load per length at which the tissue tears; more than 0
};

/// The needle is rigid and turns about a fulcrum, the hole that it first went in by. A point of the
/// shaft at s [m] from there was pushed aside, by how far it is from where it came into the tissue:
/// a spring for each length ds of the shaft from s0 to s1 stores stiffness |s direction -
/// channel(s)|^2 / 2 ds. Of the channel only its mean direction a, weighted by s^2, has a part in
/// the force, so that is all that is kept: with the moment M = (s1^3 - s0^3) / 3 and the tip at a
/// distance of L the tip feels
///   stiffness M / L (a - direction), less its part along the needle.
/// A needle s1 = L deep in one tissue, turned by a small angle until its tip is u off, feels
/// stiffness L u / 3. Length comes in where the needle lies, unstretched; length that leaves takes
/// its energy with it. Where the mean load would exceed the strength, the channel gives way and
/// stays where it is then. So it is passive: apart from what is lost by that, a spring. The force
/// is at most stiffness L^2 / 3 per unit of |a - direction|, which is 2 at most. A value; real-time
/// safe.
class ShaftChannel {
 public:
  /// The tissue holds the shaft from `begin` to `end` [m] from the fulcrum, and the needle lies
  /// along `direction`
  /// [-]. Returns the moment [N m] about the fulcrum that draws the direction back, square to it:
  /// the force [N] on a tip that is L [m] away is that divided by L.
  [[nodiscard]] Vec3 step(const ChannelLaw& law, double begin, double end,
                          const Vec3& direction) noexcept;

  /// [J] In a tissue as stiff as `stiffness` [N/m^2], about a needle that lies along `direction`
  /// [-].
  [[nodiscard]] double stored(double stiffness, const Vec3& direction) const noexcept {
    const Vec3 aside = direction_ - direction;
    return 0.5 * stiffness * moment_ * glm::dot(aside, aside);
  }

  /// [-] Mean direction from the fulcrum; at most 1 long.
  [[nodiscard]] const Vec3& direction() const noexcept { return direction_; }
  /// [m^3] (end^3 - begin^3) / 3 of the last step.
  [[nodiscard]] double moment() const noexcept { return moment_; }

 private:
  Vec3 direction_{0.0, 0.0, 0.0};
  double moment_ = 0.0;
};

}  // namespace palpate
