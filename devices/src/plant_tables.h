#pragma once
// Exact steps of a device with a hand; each step length is the longest one divided by a power of
// two.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "palpate/devices/device_model.h"

namespace palpate::devices {

/// The state of one axis: see plant_matrix.h for the entries.
using PlantState = std::array<double, 9>;

/// A step of one length, while the device moves or sticks.
struct PlantStep {
  std::array<double, 45> next{};   ///< the first five entries of the state after it, by rows
  std::array<double, 81> speed{};  ///< quadratic form: the integral of v^2 [m^2/s]
  /// Quadratic form: the integral of the motor's force times v [J]; only with a lag.
  std::array<double, 81> power{};
};

/// Made at set-up, then constant. Times are whole numbers of quanta of `quantum` seconds.
struct PlantTables {
  /// The shortest step is the longest / 2^kDepth.
  static constexpr int kDepth = 40;
  /// [quanta]
  static constexpr std::int64_t kLongest = std::int64_t{1} << kDepth;

  /// Exact, by the matrix exponential. `period` [s] is a whole number of longest steps; without
  /// friction it is one.
  PlantTables(const DeviceModel& device, const std::optional<HandModel>& hand, double period);

  std::array<PlantStep, kDepth + 1> moving;    ///< [level]: the length is the longest / 2^level
  std::array<PlantStep, kDepth + 1> sticking;  ///< not made without friction
  PlantState
      /// [m/s^2] row vector: acceleration of the device while it moves; times the mass it is the
      /// net force
      acceleration{};
  PlantState jerk{};      ///< row vector: rate of change of the acceleration while it sticks
  double mass = 0.0;      ///< [kg] that moves with the device
  double friction = 0.0;  ///< [N]
  double quantum = 0.0;   ///< [s]
  bool has_lag = false;
  bool has_grip = false;
};

}  // namespace palpate::devices
