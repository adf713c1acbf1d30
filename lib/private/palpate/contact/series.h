#pragma once
/// The force of walls that differ, from one potential: each wall's own spring, in series with one
/// rigid stop.

#include <span>

#include "palpate/contact/local_projection.h"
#include "palpate/contact/shared_walls.h"

namespace palpate {

/// Walls of several kinds.
class SoftKinds {
 public:
  static constexpr std::size_t kMost = 8;
  virtual ~SoftKinds() = default;

  [[nodiscard]] virtual std::size_t count() const noexcept = 0;
  /// The nearest point to `place` [m] that the walls of kind `index` (below count()) allow, looked
  /// for from `from` [m]. Real-time safe.
  [[nodiscard]] virtual LocalProjection nearest(std::size_t index, const Vec3& from,
                                                const Vec3& place) noexcept = 0;
  /// What that kind pushes with: one law, where the proxy is.
  [[nodiscard]] virtual const SharedWalls& law(std::size_t index) const noexcept = 0;

  /// How its walls themselves change with the proxy and the press: gradients [-] of how far a place
  /// is off `on`, the nearest point to it.
  struct Change {
    Vec3 by_proxy{0.0, 0.0, 0.0};
    Vec3 by_press{0.0, 0.0, 0.0};
  };
  [[nodiscard]] virtual Change change(std::size_t index,
                                      const LocalProjection& on) const noexcept = 0;
};

struct SeriesForce {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] on the hand, the laws and the proxy staying as they are
  Vec3 place{0.0, 0.0, 0.0};  ///< [m] between the stop and the walls
  Vec3 rise{0.0, 0.0, 0.0};   ///< [N] gradient of the energy by the proxy's place, where the laws
                              ///< change with it, ...
  Vec3 by_press{0.0, 0.0,
                0.0};  ///< [N] ... and by the press (see overPatch()); neither is in the force
  Vec3 turn{0.0, 0.0, 0.0};  ///< [N] gradient of the energy by the proxy's place, where the walls
                             ///< change with it: not in the force
  double energy = 0.0;       ///< [J] stored
  bool varies = false;       ///< one of the two may be other than zero
  bool settled = false;      ///< false: Newton's steps ran out; the force is that of the last one
};

/// The hand is held to a point z by the stop, a spring of `stop` [N/m], and z by each kind of wall
/// m to the nearest point y_m that its walls allow, whatever else is there:
///   E(hand) = min over z of stop |z - hand|^2 / 2 + sum over m of W_m(|z - y_m(z)|),  force = stop
///   (z - hand) = -grad E.
/// W_m is such that one kind alone pushes by its own law. So the force has a potential whatever the
/// shapes of the walls, and is nowhere stiffer than the stop, which has to be stiffer than each
/// law, as long as the walls do not change. The laws are those at `proxy` [m], a point that all
/// walls allow, near the hand: the walls' nearest points are looked for from there. Where laws
/// differ from place to place, E changes with the proxy too: by `rise`; and where the walls change
/// with it, by `turn`. Both are to be handed on to the hand as the proxy follows it.
[[nodiscard]] SeriesForce seriesForce(const Vec3& proxy, const Vec3& hand, double stop,
                                      SoftKinds& kinds) noexcept;

}  // namespace palpate
