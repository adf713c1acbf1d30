#pragma once
/// SafetyLimits: how much of a force a device may pass on to a hand, and the conditions under which
/// it must stop.

#include "palpate/core/math.h"

namespace palpate::devices {

/// The limits of one device, part of its DeviceInfo. By default nothing is limited: a simulated
/// hand cannot be hurt, and its forces are compared with closed forms. handLimits() are the
/// defaults for a device that a person holds. A limit that is NaN or negative permits nothing.
struct SafetyLimits {
  double max_growth = kInfinity;  ///< [N/s] slew rate of the force vector; see ForceGuard::apply()
  /// [s] from zero to full force after open, homing, silence, a hang or a value that is not finite
  double ramp = 0.0;
  /// [m/s] of the hand, filtered with kSpeedFilter; a faster hand is a fault
  double max_speed = kInfinity;
  /// [m/s] a reading is dropped if its distance from the last good one is more than `jump_speed`
  /// times the age of that one plus `jump_slack` [m]
  double jump_speed = kInfinity;
  double jump_slack = 0.0;  ///< [m] see `jump_speed`
  /// This many dropped or non-finite readings, or non-finite forces, in a row are a fault; 0: never
  int strikes = 0;
  double continuous_force = kInfinity;  ///< [N] that the motors can hold forever
  double thermal_time = 10.0;           ///< [s] time constant of the motors' warming
  double silence = kInfinity;           ///< [s] without a valid reply after which the force is zero
  double silence_fault = kInfinity;     ///< [s] without a valid reply after which it is a fault
  /// [s] of real time without a turn of the loop after which another thread writes zero force
  /// (Device::cut())
  double hang = kInfinity;
  /// [s] of real time without a turn after which it is a fault, once the loop goes on
  double hang_fault = kInfinity;

  /// [s] time constant of the filter for the speed that is compared with max_speed.
  static constexpr double kSpeedFilter = 0.01;
  /// [-] heat of the motors above which the force is reduced; 1 is the heat that the continuous
  /// force makes.
  static constexpr double kWarm = 0.8;
};

/// The limits that a device held by a hand needs; a driver adapts them to its device.
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
