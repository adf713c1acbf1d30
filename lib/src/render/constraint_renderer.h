#pragma once
/// The `constraint` renderer (DESIGN.md section 3): the proxy minimises |x - P|^2 over its region along
/// a connected path; the wall pushes the hand back to it.

#include <array>

#include "cell_walker.h"
#include "insertion.h"
#include "layers_beneath.h"
#include "palpate/contact/maxwell_branch.h"
#include "palpate/contact/wall_spring.h"
#include "palpate/render/haptic_renderer.h"
#include "proxy_solver.h"

namespace palpate {

class ConstraintRenderer final : public HapticRenderer, private WallOpener {
 public:
  ConstraintRenderer(ScenePtr scene, const RendererSettings& settings);

 private:
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override;
  void forget() noexcept override;
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept override {
    return walker_.crossings();
  }

  void start(const Vec3& hip) noexcept;
  [[nodiscard]] bool open(const ContactSet& contact) noexcept override;
  [[nodiscard]] Vec3 shaded(const HeldWall& held, const Facet& facet, double radius) const noexcept;
  void relax(double dt) noexcept;
  [[nodiscard]] Vec3 wallForce(const HipState& hip) noexcept;
  [[nodiscard]] Vec3 contentForce(const HipState& hip) noexcept;
  [[nodiscard]] MaterialMap::Sample stiffnessOf(const WallContact& contact) noexcept;
  [[nodiscard]] double contentShare() noexcept;
  void fadeContent(const Vec3& hip) noexcept;
  [[nodiscard]] const Material& wallMaterial(const Facet& facet) const noexcept {
    return scene_->materials()[static_cast<std::size_t>(facet.material)];
  }
  /// The spring of a held wall at the proxy.
  [[nodiscard]] WallSpring springOf(const WallContact& contact) noexcept {
    const Material& wall = wallMaterial(contact.facet);
    const Vec3& x = walker_.position();
    return {stiffnessOf(contact).value, wall.curve.stiffening.at(x), wall.curve.exponent,
            wall.curve.reference};
  }

  ScenePtr scene_;
  CellWalker walker_;
  LayersBeneath beneath_;
  ProxySolver solver_;
  FrictionState friction_;
  int pressed_ = -1;  ///< material of the wall pressed last, in this contact; -1: none
  bool started_ = false;
  bool is_first_ = true;  ///< no tick yet
  Vec3 last_hip_{0.0, 0.0, 0.0};
  RegionId felt_region_ = kOutside;
  double content_share_ = 1.0;
  struct {
    MaxwellBranch state;
    double depth = 0.0;          ///< [m] at the last tick
    int material = -1;           ///< of the wall pressed; -1: none
    RegionId region = kOutside;  ///< from where
  } branch_;
  Insertion insertion_;
};

}  // namespace palpate
