#pragma once
/// The force of walls that differ, from one potential: each wall's own spring, in series with one rigid stop.

#include <span>

#include "palpate/contact/local_projection.h"
#include "palpate/contact/wall_law.h"

namespace palpate {

/// A wall's law at one place, and how it changes with the place.
struct FeltWall {
  WallLaw law;
  Vec3 height_rise{0.0, 0.0, 0.0};      ///< [-] gradient of its height by the place, ...
  Vec3 stiffness_rise{0.0, 0.0, 0.0};   ///< [N/m^2] ... of its stiffness ...
  Vec3 stiffening_rise{0.0, 0.0, 0.0};  ///< [N/m^3] ... and of its stiffening
  Vec3 stiffness_press{0.0, 0.0,
                       0.0};  ///< [N/m^2] gradient of its stiffness by the press: see overPatch()

  [[nodiscard]] bool isEven() const noexcept {
    return height_rise == Vec3(0.0) && stiffness_rise == Vec3(0.0) && stiffening_rise == Vec3(0.0);
  }
  /// [N] What the energy, `depth` [m] deep, rises by with the place.
  [[nodiscard]] Vec3 rise(double depth) const noexcept;
};

/// Walls of one kind, as they are near one place.
struct SoftWalls {
  LocalProjection on;  ///< the nearest point that they allow
  FeltWall felt;       ///< there
};

/// Walls of several kinds.
class SoftKinds {
 public:
  static constexpr std::size_t kMost = 8;
  virtual ~SoftKinds() = default;

  [[nodiscard]] virtual std::size_t count() const noexcept = 0;
  /// Kind `index` (below count()) for something at `place` [m]: the walls' nearest point to it, looked for from
  /// `from` [m], and what they are like there. Real-time safe.
  virtual void look(std::size_t index, const Vec3& from, const Vec3& place,
                    SoftWalls& out) noexcept = 0;
};

struct SeriesForce {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] on the hand
  Vec3 place{0.0, 0.0, 0.0};  ///< [m] between the stop and the walls
  Vec3 by_press{0.0, 0.0,
                0.0};    ///< [N] gradient of the energy by the press, which is not in the force
  double energy = 0.0;   ///< [J] stored
  bool settled = false;  ///< false: Newton's steps ran out; the force is that of the last one
};

/// The hand is held to a point z by the stop, a spring of `stop` [N/m], and z by each kind of wall m to the nearest point
/// y_m that its walls allow, whatever else is there:
///   E(hand) = min over z of stop |z - hand|^2 / 2 + sum over m of W_m(|z - y_m(z)|),  force = stop (z - hand) = -grad E.
/// W_m is such that one kind alone pushes by its own law. So the force has a potential whatever the shapes of the walls,
/// and is nowhere stiffer than the stop, which has to be stiffer than each law.
/// `proxy` [m] is a point that all walls allow, near the hand: their nearest points are looked for from there.
[[nodiscard]] SeriesForce seriesForce(const Vec3& proxy, const Vec3& hand, double stop,
                                      SoftKinds& kinds) noexcept;

}  // namespace palpate
