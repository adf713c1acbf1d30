#pragma once
/// Feel: which force the walls and the contents make of where the solver brought the proxy.

#include "content_fade.h"
#include "felt_walls.h"
#include "palpate/render/contents.h"
#include "palpate/render/tick_state.h"
#include "proxy_solver.h"

namespace palpate {

/// Belongs to one renderer, whose state and walker outlive it. Real-time safe but for the
/// constructor.
class Feel {
 public:
  Feel(const Scene& scene, CellWalker& walker, TickState& state)
      : scene_(scene), walker_(walker), state_(state), walls_(scene, walker), fade_(scene) {}

  /// The force [N] of the walls that hold the proxy.
  [[nodiscard]] Vec3 walls(const ContactSet& contact, const HipState& hip) noexcept;
  /// [J] What the springs of the walls that hold the proxy store against the hand at `hip` [m].
  [[nodiscard]] double stored(const ContactSet& contact, const Vec3& hip) noexcept;
  /// Which share of the content is felt at the proxy now; once a tick.
  void fadeContent(const Vec3& hip) noexcept;
  /// The spring of a held wall at the proxy.
  [[nodiscard]] WallSpring springOf(const WallContact& contact) noexcept {
    const Material& wall = wallMaterial(contact.facet);
    const Vec3& x = walker_.position();
    return {walls_.stiffness(contact.leaf, contact.facet, contact.held, x).value,
            wall.curve.stiffening.at(x), wall.curve.exponent, wall.curve.reference};
  }

 private:
  /// What the springs of walls come to.
  struct SpringForce {
    double energy = 0.0;        ///< [J]
    Vec3 force{0.0, 0.0, 0.0};  ///< [N]
    Vec3 held{0.0, 0.0, 0.0};   ///< [N] to be taken off it: of what the walls do not hold
    double stiffness = 0.0;     ///< [N/m] against what friction holds
    Vec3 rise{0.0, 0.0, 0.0};   ///< [N] by the place of the proxy, what is stored changes by
    bool varies = false;        ///< the rise may be other than zero, and is not in the force
    Vec3 turn{0.0, 0.0, 0.0};   ///< [N] of it, by the planes that turn with the proxy
  };

  /// What the springs store and push with, all in all.
  struct Elastic {
    double energy = 0.0;        ///< [J]
    Vec3 push{0.0, 0.0, 0.0};   ///< [N]
    bool is_held_back = false;  ///< the push is less than what the energy falls by
  };

  void relax(const ContactSet& contact, const HipState& hip) noexcept;
  [[nodiscard]] bool countSudden(const ContactSet& contact, const Vec3& hip) noexcept;
  void countLeap(const ContactSet& contact, const HipState& hip, const Elastic& elastic,
                 double counted) noexcept;
  [[nodiscard]] SpringForce evenForce(const ContactSet& contact, const Vec3& apart) noexcept;
  [[nodiscard]] SpringForce mixedForce(const ContactSet& contact, const Vec3& apart,
                                       const Vec3& outward) noexcept;
  [[nodiscard]] double contentShare() noexcept;
  [[nodiscard]] const Material& wallMaterial(const Facet& facet) const noexcept {
    return scene_.materials()[static_cast<std::size_t>(facet.material)];
  }

  const Scene& scene_;
  CellWalker& walker_;
  TickState& state_;
  FeltWalls walls_;
  ContentFade fade_;
};

}  // namespace palpate
