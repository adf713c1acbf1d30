#pragma once
/// What tissue adds to a wall's plain spring and to a content's drag. SI throughout. What is a Parameter
/// may differ from place to place.

#include <numbers>

#include "palpate/materials/parameter.h"

namespace palpate {

/// How a wall's spring departs from a straight line: pressed d deep it pushes with
///   stiffness * reference * (d / reference)^exponent + stiffening * d^2.
/// exponent 1: a1 d + a2 d^2 (Okamura, Simone and O'Leary 2004); 1.5: Hertz' sphere.
struct SpringCurve {
  static constexpr double kHighestExponent = 4.0;

  Parameter stiffening;   ///< [N/m^2] a2, 0 or more
  double exponent = 1.0;  ///< [-] 1 to kHighestExponent
  double reference =
      1e-3;  ///< [m] the depth at which the power law pushes as the straight spring does
};

/// A Maxwell branch beside a wall's spring: a spring behind a dashpot, which pushes back against being
/// pressed and then relaxes (Mahvash and Dupont 2010).
struct Maxwell {
  Parameter stiffness;  ///< [N/m] K', 0: none
  double time = 0.0;    ///< [s] tau, positive where there is a stiffness
};

/// A periodic force inside: along each axis i, -force * sin(2 pi (x_i - origin_i) / wavelength_i). It is
/// the slope of a potential.
struct Lattice {
  Parameter force;                 ///< [N] 0: none; at most highestForce()
  Vec3 wavelength{0.0, 0.0, 0.0};  ///< [m] 0: no waves along this axis
  Vec3 origin{0.0, 0.0, 0.0};      ///< [m, world] where the force is zero and pulls back to

  [[nodiscard]] bool hasWaves() const noexcept { return wavelength != Vec3(0.0); }
  /// [N] Where its force changes fastest a lattice is a spring of 2 pi force / wavelength. It must not be
  /// stiffer than `stiffness` [N/m], that of its own material: what a stable hand can hold.
  [[nodiscard]] double highestForce(double stiffness) const noexcept {
    double shortest = kInfinity;
    for (int i = 0; i < 3; ++i) {
      if (wavelength[i] > 0.0) shortest = wavelength[i] < shortest ? wavelength[i] : shortest;
    }
    return stiffness * shortest / (2.0 * std::numbers::pi);
  }
};

/// Friction along the part of a needle's shaft that is in a tissue, per length of that part: Karnopp's
/// model as modified by Okamura, Simone and O'Leary (2004), with a spring for what sticks.
struct ShaftFriction {
  struct Way {
    Parameter static_force;  ///< [N/m] D: held by up to this
    Parameter
        kinetic_force;  ///< [N/m] C: while it slides; counts as `static_force` where a map exceeds that
    Parameter damping;  ///< [N s/m^2] b: while it slides, on top, times the speed
  };
  Way in;                  ///< while the needle goes in
  Way out;                 ///< while it is drawn out
  double stiffness = 0.0;  ///< [N/m^2] of the tissue that sticks to it, per length; 0: no friction
  double stick_speed = 0.0;  ///< [m/s] what slides slower sticks again, as what turns around does

  /// Against sideways motion of that part: a Winkler foundation, as for beams in an elastic medium (Vesic 1961).
  struct Lateral {
    double stiffness = 0.0;  ///< [N/m^2] load per length over displacement; 0: none
    double strength =
        kInfinity;  ///< [N/m] mean load per length at which the tissue tears; more than 0
  };
  Lateral lateral;
};

}  // namespace palpate
