#pragma once
/// How a device's own space lies in the world.

#include "palpate/core/math.h"

namespace palpate {

/// World = offset + scale * rotation * device, in [m]; forces go back by the rotation, `force` times as large. So the hand does
/// force / scale times the work that is done in the world, and a stiffness is felt scale * force times as stiff.
/// The workspace is what the device's tip can be brought to.
struct DeviceMapping {
  Vec3 offset{0.0, 0.0, 0.0};  ///< [m, world] where the device's origin is
  Mat3 rotation{1.0};          ///< [-] of the device's axes into the world's; proper
  double scale = 1.0;          ///< [-] world per device, more than 0
  double force = 1.0;          ///< [-] force at the hand per force in the world, more than 0
  bool clutch = false;  ///< the hand can let go and take hold elsewhere: all the world is in reach
  Box3 workspace{Vec3(-kInfinity), Vec3(kInfinity)};  ///< [m, device] around it

  [[nodiscard]] Vec3 toWorld(const Vec3& device) const noexcept {
    return offset + scale * (rotation * device);
  }
  /// [m/s, world] of [m/s, device]
  [[nodiscard]] Vec3 velocityToWorld(const Vec3& device) const noexcept {
    return scale * (rotation * device);
  }
  /// [N, device] at the hand, of [N, world]
  [[nodiscard]] Vec3 forceToDevice(const Vec3& world) const noexcept {
    return force * (glm::transpose(rotation) * world);
  }
  /// [-] Work at the hand per work in the world.
  [[nodiscard]] double workAtHand() const noexcept { return force / scale; }
  /// [-] Stiffness at the hand per stiffness in the world.
  [[nodiscard]] double stiffnessAtHand() const noexcept { return force * scale; }

  /// [m, world] A box around what a hand can get to; everything if the workspace is not bounded or there is a clutch.
  [[nodiscard]] Box3 reach() const noexcept {
    if (clutch || !workspace.isBounded()) return {Vec3(-kInfinity), Vec3(kInfinity)};
    return Pose{scale * rotation, offset}.apply(workspace);
  }
};

}  // namespace palpate
