#pragma once
/// SafetyLimits: how much of a force a device may pass on to a hand, and what it must stop for.

#include "palpate/core/math.h"

namespace palpate::devices {

/// Of one device; DeviceInfo has them. By default nothing is limited: a simulated hand cannot be
/// hurt, and its forces are compared with closed forms. handLimits() has what a device that a
/// person holds starts from. A limit that is NaN or below 0 permits nothing.
struct SafetyLimits {
  double max_growth = kInfinity;  ///< [N/s] slew rate of the force vector; see ForceGuard::apply()
  /// [s] from zero to full force after open, homing, silence, a hang or a value that is not finite
  double ramp = 0.0;
  /// [m/s] of the hand, as a filter of kSpeedFilter sees it; beyond it: fault
  double max_speed = kInfinity;
  /// [m/s] a reading further from the last good one than `jump_speed` times its age plus
  /// `jump_slack` [m] is dropped
  double jump_speed = kInfinity;
  double jump_slack = 0.0;
  /// Dropped readings, or values that are not finite, in a row that make a fault; 0: never
  int strikes = 0;
  double continuous_force = kInfinity;  ///< [N] that the motors hold forever
  double thermal_time = 10.0;           ///< [s] time constant of their warming
  double silence = kInfinity;           ///< [s] without a valid reply: zero force
  double silence_fault = kInfinity;     ///< [s] the same: fault
  /// [s] real time without a turn of the loop: another thread writes zero force (Device::cut())
  double hang = kInfinity;
  double hang_fault = kInfinity;  ///< [s] the same: fault, once the loop goes on

  /// [s] time constant of the speed that max_speed is compared with.
  static constexpr double kSpeedFilter = 0.01;
  /// [-] of the motors' heat from which on the force is held back; full heat is what the continuous
  /// force makes.
  static constexpr double kWarm = 0.8;
};

/// What a device that a hand holds needs; a driver changes what its device asks for.
[[nodiscard]] inline SafetyLimits handLimits() noexcept {
  SafetyLimits limits;
  limits.max_growth = 2000.0;
  limits.ramp = 0.5;
  limits.max_speed = 2.0;
  limits.jump_speed = 10.0;
  limits.jump_slack = 5e-3;
  limits.strikes = 3;
  limits.silence = 0.01;
  limits.silence_fault = 0.1;
  limits.hang = 0.02;
  limits.hang_fault = 0.1;
  return limits;
}

}  // namespace palpate::devices
