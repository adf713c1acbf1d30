#pragma once
/// The `constraint` renderer: ProxySolver brings the proxy to where |x - P|^2 is smallest in its
/// region, along a connected path; Feel turns the result into the force on the hand.

#include "cell_walker.h"
#include "feel.h"
#include "proxy_solver.h"
#include "renderer_base.h"

namespace palpate {

class ConstraintRenderer final : public RendererBase, private WallOpener {
 public:
  ConstraintRenderer(ScenePtr scene, const RendererSettings& settings);

 private:
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override;
  void resume() noexcept override;
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept override {
    return walker_.crossings();
  }
  [[nodiscard]] std::span<const RegionEntry> entered() const noexcept override {
    return walker_.entries();
  }

  void start(const Vec3& hip) noexcept;
  [[nodiscard]] bool open(const ContactSet& contact) noexcept override;
  [[nodiscard]] Vec3 contentForce(const HipState& hip) noexcept;
  [[nodiscard]] Vec3 needleForce(const HipState& hip) noexcept;

  CellWalker walker_;
  ProxySolver solver_;
  Feel feel_;

  // Values of this tick.
  Vec3 hand_{0.0, 0.0, 0.0};      ///< [m]
  Vec3 velocity_{0.0, 0.0, 0.0};  ///< [m/s] of the hand
  bool has_given_way_ = false;    ///< a wall gave way
  double released_ = 0.0;         ///< [J] energy that was stored in the first wall that gave way
};

}  // namespace palpate
