#pragma once
/// The force of walls with different laws, from one potential: each wall's own spring, in series
/// with one rigid stop.

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
  /// The nearest point to `place` [m] that satisfies the walls of kind `index` (below count()); the
  /// search begins at `from` [m]. Real-time safe.
  [[nodiscard]] virtual LocalProjection nearest(std::size_t index, const Vec3& from,
                                                const Vec3& place) noexcept = 0;
  /// The force law of that kind, as it is where the proxy is.
  [[nodiscard]] virtual const SharedWalls& law(std::size_t index) const noexcept = 0;

  /// How the walls of a kind themselves change with the proxy and the press: gradients [-] of the
  /// distance from a place to `on`, its nearest point.
  struct Change {
    Vec3 by_proxy{0.0, 0.0, 0.0};
    Vec3 by_press{0.0, 0.0, 0.0};
  };
  [[nodiscard]] virtual Change change(std::size_t index,
                                      const LocalProjection& on) const noexcept = 0;
};

struct SeriesForce {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] on the hand, for constant laws and a constant proxy
  Vec3 place{0.0, 0.0, 0.0};  ///< [m] point between the stop and the walls (z below)
  /// [N] gradient of the energy by the proxy's place, through the laws that change with it ...
  Vec3 rise{0.0, 0.0, 0.0};
  Vec3 by_press{0.0, 0.0,
                0.0};  ///< [N] ... and by the press (see overPatch()); neither is part of `force`
  /// [N] gradient of the energy by the proxy's place, through walls that change with it; not part
  /// of `force`
  Vec3 turn{0.0, 0.0, 0.0};
  double energy = 0.0;   ///< [J] stored
  bool varies = false;   ///< `rise` or `by_press` may be nonzero
  bool settled = false;  ///< false: Newton's steps ran out; the force is that of the last one
};

/// The stop, a spring of `stop` [N/m], connects the hand to a point z. Each kind of wall m connects
/// z to the nearest point y_m that this kind's walls permit, whatever other walls there are:
///   E(hand) = min over z of stop |z - hand|^2 / 2 + sum over m of W_m(|z - y_m(z)|),
///   force = stop (z - hand) = -grad E.
/// W_m is chosen such that one kind alone pushes by its own law. So the force has a potential
/// whatever the shapes of the walls, and is nowhere stiffer than the stop, which must be stiffer
/// than each law, as long as the walls do not change. The laws are those at `proxy` [m], a point
/// near the hand that satisfies all walls; the search for the walls' nearest points begins there.
/// Where laws differ from place to place, E also changes with the proxy: `rise` is that gradient;
/// and where the walls change with it, `turn`. Both must be carried over to the hand by the chain
/// rule as the proxy follows it.
[[nodiscard]] SeriesForce seriesForce(const Vec3& proxy, const Vec3& hand, double stop,
                                      SoftKinds& kinds) noexcept;

}  // namespace palpate
