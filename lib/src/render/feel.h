#pragma once
/// Feel: which force the walls and the contents make of where the solver brought the proxy.

#include "layers_beneath.h"
#include "palpate/contact/wall_spring.h"
#include "palpate/render/contents.h"
#include "palpate/render/renderer_state.h"
#include "proxy_solver.h"

namespace palpate {

/// Belongs to one renderer, whose state and walker outlive it. Real-time safe but for the constructor.
class Feel {
 public:
  Feel(const Scene& scene, CellWalker& walker, RendererState& state)
      : scene_(scene), walker_(walker), state_(state), beneath_(scene) {}

  /// The force [N] of the walls that hold the proxy.
  [[nodiscard]] Vec3 walls(const ContactSet& contact, const HipState& hip) noexcept;
  /// Which share of the content is felt at the proxy now; once a tick.
  void fadeContent(const Vec3& hip) noexcept;
  /// The spring of a held wall at the proxy.
  [[nodiscard]] WallSpring springOf(const WallContact& contact) noexcept {
    const Material& wall = wallMaterial(contact.facet);
    const Vec3& x = walker_.position();
    return {stiffnessOf(contact).value, wall.curve.stiffening.at(x), wall.curve.exponent,
            wall.curve.reference};
  }

 private:
  void relax(const ContactSet& contact, double dt) noexcept;
  [[nodiscard]] Vec3 shaded(const HeldWall& held, const Facet& facet, double radius) const noexcept;
  [[nodiscard]] MaterialMap::Sample stiffnessOf(const WallContact& contact) noexcept;
  [[nodiscard]] double contentShare() noexcept;
  [[nodiscard]] const Material& wallMaterial(const Facet& facet) const noexcept {
    return scene_.materials()[static_cast<std::size_t>(facet.material)];
  }

  const Scene& scene_;
  CellWalker& walker_;
  RendererState& state_;
  LayersBeneath beneath_;
};

}  // namespace palpate
