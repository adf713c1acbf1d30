#pragma once
/// How walls push back and how contents feel: parameters that are the same everywhere or differ
/// from place to place, and the materials made of them. SI throughout. What is a Parameter may
/// differ from place to place.

#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate {

/// A quantity of SI unit that depends on where one is: a grid of a file, an image behind a transfer
/// function, or a function of one's own. Immutable and shared; value() and sample() are real-time
/// safe.
class PALPATE_EXPORT MaterialMap {
 public:
  struct Sample {
    double value = 0.0;            ///< [SI unit of the parameter]
    Vec3 gradient{0.0, 0.0, 0.0};  ///< [the same per m]
  };
  struct Range {
    double least = 0.0;
    double most = 0.0;
  };

  virtual ~MaterialMap() = default;
  MaterialMap(const MaterialMap&) = delete;
  MaterialMap& operator=(const MaterialMap&) = delete;

  /// At `p` [m, world]: finite and within range() everywhere, also beyond what the map covers.
  [[nodiscard]] virtual Sample sample(const Vec3& p) const noexcept = 0;
  /// The same value, bit for bit, without the gradient.
  [[nodiscard]] virtual double value(const Vec3& p) const noexcept = 0;
  /// All values lie within; asked at set-up, to check what a parameter may be.
  [[nodiscard]] virtual Range range() const noexcept = 0;

 protected:
  MaterialMap() = default;
};
using MaterialMapPtr = std::shared_ptr<const MaterialMap>;

/// A constant, or a map. Cheap to ask where it is constant.
class Parameter {
 public:
  Parameter() = default;
  Parameter(double constant) : constant_(constant) {}  // NOLINT(google-explicit-constructor)
  Parameter(MaterialMapPtr map)                        // NOLINT(google-explicit-constructor)
      : constant_(map ? map->value(Vec3(0.0)) : 0.0), map_(std::move(map)) {}

  [[nodiscard]] bool isConstant() const noexcept { return map_ == nullptr; }
  /// The same everywhere: an equal constant, or the very same map.
  friend bool operator==(const Parameter& a, const Parameter& b) noexcept {
    return a.map_ == b.map_ && (a.map_ != nullptr || a.constant_ == b.constant_);
  }
  [[nodiscard]] double at(const Vec3& p) const noexcept {
    return map_ ? map_->value(p) : constant_;
  }
  [[nodiscard]] MaterialMap::Sample sample(const Vec3& p) const noexcept {
    return map_ ? map_->sample(p) : MaterialMap::Sample{constant_, Vec3(0.0)};
  }
  [[nodiscard]] MaterialMap::Range range() const noexcept {
    return map_ ? map_->range() : MaterialMap::Range{constant_, constant_};
  }
  /// Null where the parameter is constant.
  [[nodiscard]] const MaterialMapPtr& map() const noexcept { return map_; }

 private:
  double constant_ = 0.0;
  MaterialMapPtr map_;
};

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

/// A Maxwell branch beside a wall's spring: a spring behind a dashpot, which pushes back against
/// being pressed and then relaxes (Mahvash and Dupont 2010).
struct Maxwell {
  Parameter stiffness;  ///< [N/m] K', 0: none
  double time = 0.0;    ///< [s] tau, positive where there is a stiffness
};

/// A periodic force inside: along each axis i, -force * sin(2 pi (x_i - origin_i) / wavelength_i).
/// It is the slope of a potential.
struct Lattice {
  Parameter force;                 ///< [N] 0: none; at most highestForce()
  Vec3 wavelength{0.0, 0.0, 0.0};  ///< [m] 0: no waves along this axis
  Vec3 origin{0.0, 0.0, 0.0};      ///< [m, world] where the force is zero and pulls back to

  [[nodiscard]] bool hasWaves() const noexcept { return wavelength != Vec3(0.0); }
  /// [N] Where its force changes fastest a lattice is a spring of 2 pi force / wavelength. It must
  /// not be stiffer than `stiffness` [N/m], that of its own material: what a stable hand can hold.
  [[nodiscard]] double highestForce(double stiffness) const noexcept {
    double shortest = kInfinity;
    for (int i = 0; i < 3; ++i) {
      if (wavelength[i] > 0.0) shortest = wavelength[i] < shortest ? wavelength[i] : shortest;
    }
    return stiffness * shortest / (2.0 * std::numbers::pi);
  }
};

/// Friction along the part of a needle's shaft that is in a tissue, per length of that part:
/// Karnopp's model as modified by Okamura, Simone and O'Leary (2004), with a spring for what
/// sticks.
struct ShaftFriction {
  struct Way {
    Parameter static_force;   ///< [N/m] D: held by up to this
    Parameter kinetic_force;  ///< [N/m] C: while it slides; counts as `static_force` where a map
                              ///< exceeds that
    Parameter damping;        ///< [N s/m^2] b: while it slides, on top, times the speed
  };
  Way in;                  ///< while the needle goes in
  Way out;                 ///< while it is drawn out
  double stiffness = 0.0;  ///< [N/m^2] of the tissue that sticks to it, per length; 0: no friction
  double stick_speed = 0.0;  ///< [m/s] what slides slower sticks again, as what turns around does

  /// Against sideways motion of that part: a Winkler foundation, as for beams in an elastic medium
  /// (Vesic 1961).
  struct Lateral {
    double stiffness = 0.0;  ///< [N/m^2] load per length over displacement; 0: none
    double strength =
        kInfinity;  ///< [N/m] mean load per length at which the tissue tears; more than 0
  };
  Lateral lateral;
};

/// Friction cone of a wall, as ratios of tangential to normal force.
struct Friction {
  Parameter static_ratio;   ///< [-] 0 or more
  Parameter kinetic_ratio;  ///< [-] 0 or more; counts as static_ratio where a map exceeds that
};

/// Bumps felt on a wall: the surface is taken to stand amplitude * (sin kx + sin ky + sin kz) / 3
/// higher, k = 2 pi / wavelength, at the proxy. Never more than half of the depth pressed, so that
/// a light touch never loses contact, and the force it adds never exceeds stiffness * amplitude.
struct Texture {
  Parameter amplitude;      ///< [m] 0: smooth; at most highestAmplitude(wavelength)
  double wavelength = 0.0;  ///< [m] positive if there is an amplitude

  /// [m] wavelength / 2 pi. Higher bumps would change the force along the wall, by at most
  /// stiffness * amplitude * k per meter, faster than pressing changes it: the wall would be
  /// stiffer sideways than a hand that is stable on the wall itself can hold.
  [[nodiscard]] static constexpr double highestAmplitude(double wavelength) noexcept {
    return wavelength / (2.0 * std::numbers::pi);
  }
};

/// What lies beneath a wall, felt through it (contact/layered.h): a stiff lump, a hard ground. Off
/// where the radius is 0.
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
/// shading; a content uses viscosity and flow. A material may serve as both. What is a Parameter
/// may differ from place to place: it is asked for at the proxy. Where a wall's stiffness K does,
/// the spring of length d has the energy K d^2 / 2, and the force the term -d^2 / 2 grad K that
/// goes with it, by the chain rule from the proxy to the hand; without it a way there and back
/// would gain energy. While friction holds the proxy where it is, K does not change and there is no
/// such term. (The paper's renderer, which keeps to the source's force law, never has it.)
struct Material {
  std::string name = {};
  Parameter stiffness;  ///< [N/m] 0 or more; a wall needs more than 0 everywhere
  Parameter damping;    ///< [N s/m] against the probe's velocity while a wall is touched
  Friction friction = {};
  Texture texture = {};
  Composite composite = {};
  double shading = 0.0;  ///< [m] the force follows the normal averaged over this radius, so that
                         ///< the facets of a coarse mesh feel round; 0: off
  Parameter viscosity;   ///< [N s/m] Bv of the drag -Bv V while inside
  Flow flow = {};        ///< velocity of the medium: drag is -Bv (V - flow)

  // Of tissue and needles. What a content presses with has the material's own stiffness.
  SpringCurve curve = {};  ///< of a wall
  Maxwell maxwell = {};    ///< of a wall
  Lattice lattice = {};    ///< of a content
  Parameter cutting =
      {};  ///< [N] of a content: what moves a tip on where it has not been; 0: nothing
  ShaftFriction shaft = {};  ///< of a content
};

}  // namespace palpate
