#pragma once
/// Mechanical models of a device and of the hand that holds it: masses, springs and friction at the
/// tip.

#include <string>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

/// A device at its tip, with the same parameters along its three axes, which are independent of
/// each other.
struct DeviceModel {
  std::string name = {};  ///< for reports; may be empty
  double mass = 0.1;      ///< [kg] more than 0
  double damping = 0.0;   ///< [N s/m] viscous, 0 or more
  double friction = 0.0;  ///< [N] Coulomb friction, the same when sticking and sliding; 0 or more
  double encoder = 0.0;   ///< [m] step of a reading; 0: none
  double lag = 0.0;       ///< [s] time constant of the amplifier; 0: none
  double max_force = kInfinity;  ///< [N] the most that the motors exert; more than 0
  Box3 workspace{Vec3(-kInfinity), Vec3(kInfinity)};  ///< [m, device] the reach of the tip
};

/// A hand: a mass on a spring and a damper, whose other end follows the path that the hand wants to
/// take. It holds the device by a grip (another spring and damper), or is rigidly connected to it.
struct HandModel {
  std::string name = {};        ///< for reports; may be empty
  double mass = 0.0;            ///< [kg] 0 or more; with a grip more than 0
  double damping = 0.0;         ///< [N s/m] to the path, 0 or more
  double stiffness = 0.0;       ///< [N/m] to the path, 0 or more
  double grip_stiffness = 0.0;  ///< [N/m] 0 or more; both 0: the hand is fixed to the device
  double grip_damping = 0.0;    ///< [N s/m] 0 or more

  /// False: the hand is rigidly connected to the device.
  [[nodiscard]] bool hasGrip() const noexcept { return grip_stiffness > 0.0 || grip_damping > 0.0; }
};

/// @throws Error (kUsage, device.model) for a value out of its range.
PALPATE_EXPORT void check(const DeviceModel& device);
/// @throws Error (kUsage, device.model) likewise, and for a hand with a grip but without mass.
PALPATE_EXPORT void check(const HandModel& hand);

}  // namespace palpate::devices
