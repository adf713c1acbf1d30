#pragma once
// What all rivals share.

#include <vector>

#include "palpate/render/haptic_renderer.h"

namespace palpate::rivals {

/// One solid of the scene.
struct Solid {
  FieldPtr field;
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
};

class RivalRenderer : public HapticRenderer {
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
  /// As before the first tick.
  virtual void forget() noexcept = 0;

  void resume() noexcept final { forget(); }
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept final { return {}; }
  [[nodiscard]] std::span<const RegionEntry> entered() const noexcept final { return {}; }

  std::vector<Solid> solids_;
};

/// Steps of Newton's from `p` onto the surface: for a distance one is all.
[[nodiscard]] Vec3 downTheGradient(const Field& field, Vec3 p) noexcept;

}  // namespace palpate::rivals
