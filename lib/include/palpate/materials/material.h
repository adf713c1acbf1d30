#pragma once
/// How walls push back and how contents feel: parameters, and the materials made of them. All in
/// SI. A Parameter may be constant or differ from place to place.

#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate {

/// A quantity, in its SI unit, that depends on the place: a grid from a file, an image behind a
/// transfer function, or a function supplied by the caller. Immutable and shared; value() and
/// sample() are real-time safe.
class PALPATE_EXPORT MaterialMap {
 public:
  /// The parameter at a point, with its gradient.
  struct Sample {
    double value = 0.0;            ///< [SI unit of the parameter]
    Vec3 gradient{0.0, 0.0, 0.0};  ///< [the same per m]
  };
  /// Bounds of a parameter.
  struct Range {
    double least = 0.0;  ///< [SI unit of the parameter] no value is below
    double most = 0.0;   ///< [SI unit of the parameter] no value is above
  };

  virtual ~MaterialMap() = default;
  MaterialMap(const MaterialMap&) = delete;
  MaterialMap& operator=(const MaterialMap&) = delete;

  /// At `p` [m, world]: finite and within range() everywhere, also outside the area that the map
  /// covers.
  [[nodiscard]] virtual Sample sample(const Vec3& p) const noexcept = 0;
  /// The same value, bit for bit, without the gradient.
  [[nodiscard]] virtual double value(const Vec3& p) const noexcept = 0;
  /// Bounds of all values; read at set-up, to check that the parameter permits them.
  [[nodiscard]] virtual Range range() const noexcept = 0;

 protected:
  MaterialMap() = default;
};
using MaterialMapPtr = std::shared_ptr<const MaterialMap>;  ///< shared; null: there is no map

/// A constant, or a map. Cheap to read where it is constant.
class Parameter {
 public:
  Parameter() = default;  ///< 0 everywhere
  /// `constant` [SI unit of the parameter] everywhere.
  Parameter(double constant) : constant_(constant) {}  // NOLINT(google-explicit-constructor)
  /// As `map` states; if it is null, 0 everywhere.
  Parameter(MaterialMapPtr map)  // NOLINT(google-explicit-constructor)
      : constant_(map ? map->value(Vec3(0.0)) : 0.0), map_(std::move(map)) {}

  /// True if there is no map.
  [[nodiscard]] bool isConstant() const noexcept { return map_ == nullptr; }
  /// The same everywhere: an equal constant, or the very same map.
  friend bool operator==(const Parameter& a, const Parameter& b) noexcept {
    return a.map_ == b.map_ && (a.map_ != nullptr || a.constant_ == b.constant_);
  }
  /// [SI unit] The value at `p` [m, world]. Real-time safe.
  [[nodiscard]] double at(const Vec3& p) const noexcept {
    return map_ ? map_->value(p) : constant_;
  }
  /// The value at `p` [m, world] and its gradient, zero for a constant. Real-time safe.
  [[nodiscard]] MaterialMap::Sample sample(const Vec3& p) const noexcept {
    return map_ ? map_->sample(p) : MaterialMap::Sample{constant_, Vec3(0.0)};
  }
  /// Bounds of the value over all of space.
  [[nodiscard]] MaterialMap::Range range() const noexcept {
    return map_ ? map_->range() : MaterialMap::Range{constant_, constant_};
  }
  /// Null where the parameter is constant.
  [[nodiscard]] const MaterialMapPtr& map() const noexcept { return map_; }

 private:
  double constant_ = 0.0;
  MaterialMapPtr map_;
};

/// The force curve of a wall's spring where it is not linear: at depth d the wall pushes with
///   stiffness * reference * (d / reference)^exponent + stiffening * d^2.
/// exponent 1: a1 d + a2 d^2 (Okamura, Simone and O'Leary 2004); 1.5: a Hertz contact with a
/// sphere.
struct SpringCurve {
  /// [-] The largest exponent.
  static constexpr double kHighestExponent = 4.0;

  Parameter stiffening;   ///< [N/m^2] a2, 0 or more
  double exponent = 1.0;  ///< [-] 1 to kHighestExponent
  double reference =
      1e-3;  ///< [m] the depth at which the power law pushes as hard as the linear spring
};

/// A Maxwell branch in parallel with a wall's spring: a spring in series with a dashpot, which
/// resists being pressed and then relaxes (Mahvash and Dupont 2010).
struct Maxwell {
  Parameter stiffness;  ///< [N/m] K', 0: none
  double time = 0.0;    ///< [s] tau, positive where there is a stiffness
};

/// A periodic force inside a content: along each axis i, -force * sin(2 pi (x_i - origin_i) /
/// wavelength_i). It is the gradient of a potential.
struct Lattice {
  Parameter force;                 ///< [N] 0: none; at most highestForce()
  Vec3 wavelength{0.0, 0.0, 0.0};  ///< [m] 0: no waves along this axis
  Vec3 origin{0.0, 0.0, 0.0};  ///< [m, world] where the force is zero, and towards which it pulls

  /// False: there is no force along any axis.
  [[nodiscard]] bool hasWaves() const noexcept { return wavelength != Vec3(0.0); }
  /// [N] The largest `force` allowed. Where its force changes fastest, a lattice acts like a spring
  /// of 2 pi force / wavelength. It must not be stiffer than `stiffness` [N/m], that of its own
  /// material, which a stable hand can hold.
  [[nodiscard]] double highestForce(double stiffness) const noexcept {
    double shortest = kInfinity;
    for (int i = 0; i < 3; ++i) {
      if (wavelength[i] > 0.0) shortest = wavelength[i] < shortest ? wavelength[i] : shortest;
    }
    return stiffness * shortest / (2.0 * std::numbers::pi);
  }
};

/// Friction along the part of a needle's shaft that is in a tissue, per length of that part:
/// Karnopp's model as modified by Okamura, Simone and O'Leary (2004), with a spring while it
/// sticks.
struct ShaftFriction {
  /// Friction while the shaft slides in one direction.
  struct Way {
    Parameter static_force;  ///< [N/m] D: the largest force while it sticks
    /// [N/m] C: while it slides; counts as `static_force` where a map exceeds that
    Parameter kinetic_force;
    Parameter damping;  ///< [N s/m^2] b: while it slides, on top, times the speed
  };
  Way in;                  ///< while the needle goes in
  Way out;                 ///< while it is drawn out
  double stiffness = 0.0;  ///< [N/m^2] of the tissue that sticks to it, per length; 0: no friction
  double stick_speed = 0.0;  ///< [m/s] a slower shaft sticks again, as does one that turns around

  /// Resistance of the tissue to sideways motion of that part of the shaft: a Winkler foundation,
  /// as for beams in an elastic medium (Vesic 1961).
  struct Lateral {
    double stiffness = 0.0;  ///< [N/m^2] load per length over displacement; 0: none
    double strength =
        kInfinity;  ///< [N/m] mean load per length at which the tissue tears; more than 0
  };
  Lateral lateral;  ///< resistance to sideways motion; none by default
};

/// Friction cone of a wall, as ratios of tangential to normal force.
struct Friction {
  Parameter static_ratio;   ///< [-] 0 or more
  Parameter kinetic_ratio;  ///< [-] 0 or more; counts as static_ratio where a map exceeds that
};

/// Bumps felt on a wall: at the proxy the surface is taken to be amplitude * (sin kx + sin ky + sin
/// kz) / 3 higher, k = 2 pi / wavelength. The change is limited to half of the depth pressed, so
/// that a light touch never loses contact, and the force it adds never exceeds stiffness *
/// amplitude.
struct Texture {
  Parameter amplitude;      ///< [m] 0: smooth; at most highestAmplitude(wavelength)
  double wavelength = 0.0;  ///< [m] positive if there is an amplitude

  /// [m] wavelength / 2 pi. Bumps change the force along the wall by up to stiffness * amplitude *
  /// k per meter. If they were higher than this, that would exceed the stiffness of the wall
  /// itself: the wall would be stiffer sideways than a hand that is stable on the wall can hold.
  [[nodiscard]] static constexpr double highestAmplitude(double wavelength) noexcept {
    return wavelength / (2.0 * std::numbers::pi);
  }
};

/// Inclusions beneath a wall that are felt through it (contact/layered.h): a stiff lump, a hard
/// ground. Off where the radius is 0.
struct Composite {
  double radius = 0.0;  ///< [m] of the patch that is pressed on
  double depth =
      0.0;  ///< [m] how far to look along the inward normal; more than 0 if there is a radius
};

/// A velocity whose components, along the axes of the world, may each differ from place to place.
struct Flow {
  Parameter x;  ///< [m/s] any finite number, also negative
  Parameter y;  ///< [m/s] the same along y
  Parameter z;  ///< [m/s] the same along z

  Flow() = default;  ///< at rest
  /// `v` [m/s, world] everywhere.
  Flow(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT(google-explicit-constructor)
  /// The components [m/s] along the axes of the world.
  Flow(Parameter along_x, Parameter along_y, Parameter along_z)
      : x(std::move(along_x)), y(std::move(along_y)), z(std::move(along_z)) {}

  /// [m/s] at `p` [m]. Real-time safe.
  [[nodiscard]] Vec3 at(const Vec3& p) const noexcept { return {x.at(p), y.at(p), z.at(p)}; }
  /// True if each component is an equal constant or the very same map.
  friend bool operator==(const Flow& a, const Flow& b) noexcept {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

/// One named material of a scene. A wall uses stiffness, damping, friction, texture, composite and
/// shading; a content uses viscosity and flow. A material may serve as both. A Parameter may differ
/// from place to place: it is read at the proxy. Where a wall's stiffness K does, the spring of
/// length d has the energy K d^2 / 2, so the force includes the term -d^2 / 2 grad K, carried from
/// the proxy to the hand by the chain rule; without this term a way there and back would gain
/// energy. While friction holds the proxy where it is, K does not change and there is no such term.
/// (The paper's renderer, which keeps to the source's force law, never has it.)
struct Material {
  std::string name = {};     ///< by which the rest of the scene refers to it; reports show it
  Parameter stiffness;       ///< [N/m] 0 or more; a wall needs more than 0 everywhere
  Parameter damping;         ///< [N s/m] against the probe's velocity while a wall is touched
  Friction friction = {};    ///< of a wall
  Texture texture = {};      ///< of a wall
  Composite composite = {};  ///< of a wall
  /// [m] the force follows the normal averaged over this radius, so that the facets of a coarse
  /// mesh feel round; 0: off
  double shading = 0.0;
  Parameter viscosity;  ///< [N s/m] Bv of the drag -Bv V while inside
  Flow flow = {};       ///< velocity of the medium: drag is -Bv (V - flow)

  // For tissue and needles. In a content, the tip is pressed with the material's own stiffness.
  SpringCurve curve = {};  ///< of a wall
  Maxwell maxwell = {};    ///< of a wall
  Lattice lattice = {};    ///< of a content
  /// [N] of a content: the force that pushes a tip on into material not yet cut; 0: nothing
  Parameter cutting = {};
  ShaftFriction shaft = {};  ///< of a content
};

}  // namespace palpate
