#pragma once
/// Feel: turns the place to which the solver brought the proxy into the force of the walls and
/// contents.

#include "content_fade.h"
#include "felt_walls.h"
#include "palpate/render/contents.h"
#include "palpate/render/tick_state.h"
#include "proxy_solver.h"

namespace palpate {

/// Belongs to one renderer, whose state and walker must outlive it. Real-time safe except for the
/// constructor.
class Feel {
 public:
  Feel(const Scene& scene, CellWalker& walker, TickState& state)
      : scene_(scene), walker_(walker), state_(state), walls_(scene, walker), fade_(scene) {}

  /// The force [N] of the walls that hold the proxy.
  [[nodiscard]] Vec3 walls(const ContactSet& contact, const HipState& hip) noexcept;
  /// [J] The energy that the springs of the walls that hold the proxy would store with the hand at
  /// `hip` [m].
  [[nodiscard]] double stored(const ContactSet& contact, const Vec3& hip) noexcept;
  /// Updates the share of the content that is felt at the proxy; to be called once a tick.
  void fadeContent(const Vec3& hip) noexcept;
  /// The spring of a held wall at the proxy.
  [[nodiscard]] WallSpring springOf(const WallContact& contact) noexcept {
    const Material& wall = wallMaterial(contact.facet);
    const Vec3& x = walker_.position();
    return {walls_.stiffness(contact.leaf, contact.facet, contact.held, x).value,
            wall.curve.stiffening.at(x), wall.curve.exponent, wall.curve.reference};
  }

 private:
  /// Result of the springs of the walls.
  struct SpringForce {
    double energy = 0.0;        ///< [J]
    Vec3 force{0.0, 0.0, 0.0};  ///< [N]
    Vec3 held{0.0, 0.0, 0.0};   ///< [N] to be subtracted: the part that the walls do not hold
    double stiffness = 0.0;     ///< [N/m] against a displacement that friction holds
    Vec3 rise{0.0, 0.0, 0.0};   ///< [N] gradient of the stored energy by the place of the proxy
    bool varies = false;        ///< `rise` may be nonzero, and is not in the force
    Vec3 turn{0.0, 0.0, 0.0};  ///< [N] part of that gradient due to planes that turn with the proxy
  };

  /// The energy and the total force of the springs.
  struct Elastic {
    double energy = 0.0;        ///< [J]
    Vec3 push{0.0, 0.0, 0.0};   ///< [N]
    bool is_held_back = false;  ///< the force is smaller than the gradient of the energy
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
