#pragma once
/// How walls push back and how contents feel. SI throughout.

#include <numbers>
#include <string>

#include "palpate/core/math.h"

namespace palpate {

/// Friction cone of a wall, as ratios of tangential to normal force.
struct Friction {
  double static_ratio = 0.0;   ///< [-] 0 or more
  double kinetic_ratio = 0.0;  ///< [-] 0 to static_ratio
};

/// Bumps felt on a wall: the surface is taken to stand amplitude * (sin kx + sin ky + sin kz) / 3 higher,
/// k = 2 pi / wavelength, at the proxy. Never more than half of the depth pressed, so that a light touch
/// never loses contact, and the force it adds never exceeds stiffness * amplitude.
struct Texture {
  double amplitude = 0.0;   ///< [m] 0: smooth; at most highestAmplitude(wavelength)
  double wavelength = 0.0;  ///< [m] positive if there is an amplitude

  /// [m] wavelength / 2 pi. Higher bumps would change the force along the wall, by at most
  /// stiffness * amplitude * k per metre, faster than pressing changes it: the wall would be stiffer
  /// sideways than a hand that is stable on the wall itself can hold.
  [[nodiscard]] static constexpr double highestAmplitude(double wavelength) noexcept {
    return wavelength / (2.0 * std::numbers::pi);
  }
};

/// One named material of a scene. A wall uses stiffness, damping, friction, texture and shading; a
/// content uses viscosity and flow. A material may serve as both.
struct Material {
  std::string name = {};
  double stiffness = 0.0;  ///< [N/m] 0: cannot be a wall
  double damping = 0.0;    ///< [N s/m] against the probe's velocity while a wall is touched
  Friction friction = {};
  Texture texture = {};
  double shading =
      0.0;  ///< [m] the force follows the normal averaged over this radius, so that the
            ///< facets of a coarse mesh feel round; 0: off
  double viscosity = 0.0;    ///< [N s/m] Bv of the drag -Bv V while inside
  Vec3 flow{0.0, 0.0, 0.0};  ///< [m/s] velocity of the medium: drag is -Bv (V - flow)
};

}  // namespace palpate
