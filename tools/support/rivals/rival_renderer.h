#pragma once
// Shared by all rivals.

#include <span>
#include <vector>

#include "palpate/render/haptic_renderer.h"

namespace palpate::rivals {

/// One solid of the scene.
struct Solid {
  FieldPtr field;
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
};

/// The parts of the interface besides a tick: rivals cross no walls, keep the contents of the
/// scene, and have neither sources of energy nor limits of the force.
class RivalRenderer : public HapticRenderer {
 public:
  [[nodiscard]] TickResult update(const HipState& hip) noexcept final;
  [[nodiscard]] std::span<const PortCrossing> crossings() const noexcept final { return {}; }
  [[nodiscard]] std::span<const RegionEntry> entries() const noexcept final { return {}; }
  [[nodiscard]] bool setContent(RegionId /*region*/,
                                const ContentChange& /*change*/) noexcept final {
    return false;
  }
  [[nodiscard]] const Vec3& unlimitedForce() const noexcept final { return last_.force; }
  [[nodiscard]] double sourceWork() const noexcept final { return 0.0; }
  void reset() noexcept final;
  /// Their memory is not a RendererState: state() always returns that of a first tick, and no state
  /// can be set.
  [[nodiscard]] RendererState state() const noexcept final { return {}; }
  [[nodiscard]] RendererState checkpoint() noexcept final { return {}; }
  [[nodiscard]] bool setState(const RendererState& /*state*/) noexcept final { return false; }

 protected:
  /// @throws Error (kInput, rivals.no_solid)
  explicit RivalRenderer(ScenePtr scene);

  [[nodiscard]] const std::vector<Solid>& solids() const noexcept { return solids_; }
  /// The solid that `p` is deepest in; null if it is in none.
  [[nodiscard]] const Solid* deepestAt(const Vec3& p) const noexcept;

  /// A spring from the hand to `proxy`, and a damper along it that never pulls into the wall.
  [[nodiscard]] static TickResult spring(const HipState& hip, const Vec3& proxy, const Solid& solid,
                                         RegionId region) noexcept;
  [[nodiscard]] TickResult untouched(const HipState& hip) const noexcept;
  [[nodiscard]] RegionId region() const noexcept { return scene_->startRegion(); }

 private:
  /// Returns to the state before the first tick.
  virtual void forget() noexcept = 0;
  /// A tick with a valid reading.
  [[nodiscard]] virtual TickResult step(const HipState& hip) noexcept = 0;

  ScenePtr scene_;
  std::vector<Solid> solids_;
  TickResult last_;
};

/// Newton's method from `p` onto the surface: for a distance field one step is enough.
[[nodiscard]] Vec3 downTheGradient(const Field& field, Vec3 p) noexcept;

}  // namespace palpate::rivals
