#pragma once
/// How walls push back and how contents feel. SI throughout.

#include <numbers>
#include <string>
#include <utility>

#include "palpate/core/math.h"
#include "palpate/materials/parameter.h"
#include "palpate/materials/tissue.h"

namespace palpate {

/// Friction cone of a wall, as ratios of tangential to normal force.
struct Friction {
  Parameter static_ratio;   ///< [-] 0 or more
  Parameter kinetic_ratio;  ///< [-] 0 or more; counts as static_ratio where a map exceeds that
};

/// Bumps felt on a wall: the surface is taken to stand amplitude * (sin kx + sin ky + sin kz) / 3 higher,
/// k = 2 pi / wavelength, at the proxy. Never more than half of the depth pressed, so that a light touch
/// never loses contact, and the force it adds never exceeds stiffness * amplitude.
struct Texture {
  Parameter amplitude;      ///< [m] 0: smooth; at most highestAmplitude(wavelength)
  double wavelength = 0.0;  ///< [m] positive if there is an amplitude

  /// [m] wavelength / 2 pi. Higher bumps would change the force along the wall, by at most
  /// stiffness * amplitude * k per metre, faster than pressing changes it: the wall would be stiffer
  /// sideways than a hand that is stable on the wall itself can hold.
  [[nodiscard]] static constexpr double highestAmplitude(double wavelength) noexcept {
    return wavelength / (2.0 * std::numbers::pi);
  }
};

/// What lies beneath a wall, felt through it (contact/layered.h): a stiff lump, a hard ground. Off where the
/// radius is 0.
struct Composite {
  double radius = 0.0;  ///< [m] of the patch that is pressed on
  double depth =
      0.0;  ///< [m] how far along the inward normal is looked; more than 0 if there is a radius
};

/// A velocity each component of which may differ from place to place, along the axes of the world.
struct Flow {
  Parameter x;  ///< [m/s] any finite number, below 0 too
  Parameter y;
  Parameter z;

  Flow() = default;
  Flow(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT(google-explicit-constructor)
  Flow(Parameter along_x, Parameter along_y, Parameter along_z)
      : x(std::move(along_x)), y(std::move(along_y)), z(std::move(along_z)) {}

  /// [m/s] at `p` [m]. Real-time safe.
  [[nodiscard]] Vec3 at(const Vec3& p) const noexcept { return {x.at(p), y.at(p), z.at(p)}; }
  friend bool operator==(const Flow& a, const Flow& b) noexcept {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

/// One named material of a scene. A wall uses stiffness, damping, friction, texture, composite and
/// shading; a content uses viscosity and flow. A material may serve as both. What is a Parameter may differ from place
/// to place: it is asked for at the proxy. Where a wall's stiffness K does, the spring of
/// length d has the energy K d^2 / 2, and the force the term -d^2 / 2 grad K that goes with it, by the chain
/// rule from the proxy to the hand; without it a way there and back would gain energy. While friction holds
/// the proxy where it is, K does not change and there is no such term. (The paper's renderer, which keeps to
/// the source's force law, never has it.)
struct Material {
  std::string name = {};
  Parameter stiffness;  ///< [N/m] 0 or more; a wall needs more than 0 everywhere
  Parameter damping;    ///< [N s/m] against the probe's velocity while a wall is touched
  Friction friction = {};
  Texture texture = {};
  Composite composite = {};
  double shading =
      0.0;              ///< [m] the force follows the normal averaged over this radius, so that the
                        ///< facets of a coarse mesh feel round; 0: off
  Parameter viscosity;  ///< [N s/m] Bv of the drag -Bv V while inside
  Flow flow = {};       ///< velocity of the medium: drag is -Bv (V - flow)

  // Of tissue and needles. What a content presses with has the material's own stiffness.
  SpringCurve curve = {};  ///< of a wall
  Maxwell maxwell = {};    ///< of a wall
  Lattice lattice = {};    ///< of a content
  Parameter cutting =
      {};  ///< [N] of a content: what moves a tip on where it has not been; 0: nothing
  ShaftFriction shaft = {};  ///< of a content
};

}  // namespace palpate
