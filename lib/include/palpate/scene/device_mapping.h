#pragma once
/// How a device's own space lies in the world.

#include "palpate/core/math.h"

namespace palpate {

/// World = offset + scale * device, in [m]. The workspace is what the device's tip can be brought to.
struct DeviceMapping {
  Vec3 offset{0.0, 0.0, 0.0};  ///< [m, world] where the device's origin is
  double scale = 1.0;          ///< [-] world per device, more than 0
  bool clutch = false;  ///< the hand can let go and take hold elsewhere: all the world is in reach
  Box3 workspace{Vec3(-kInfinity), Vec3(kInfinity)};  ///< [m, device] around it

  [[nodiscard]] Vec3 toWorld(const Vec3& device) const noexcept { return offset + scale * device; }
  /// [m, world] What a hand can get to; everything if the workspace is not bounded or there is a clutch.
  [[nodiscard]] Box3 reach() const noexcept {
    if (clutch || !workspace.isBounded()) return {Vec3(-kInfinity), Vec3(kInfinity)};
    return {toWorld(workspace.lo), toWorld(workspace.hi)};
  }
};

}  // namespace palpate
