#pragma once
// The motion of one axis of a device with a hand.

#include <cstdint>

#include "plant_tables.h"

namespace palpate::devices {

/// The energy balance since the start, along one axis [J]. Exact except for rounding.
struct PlantWork {
  double motor = 0.0;     ///< done by the motor on the device
  double friction = 0.0;  ///< lost to Coulomb friction
  double viscous = 0.0;   ///< lost to the device's own damping
  double push = 0.0;      ///< done by the constant push
};

/// A value type; real-time safe.
class PlantAxis {
 public:
  /// Sets device and hand at rest at `x` [m].
  void start(double x, double push, double damping) noexcept;

  struct Inputs {
    double force = 0.0;      ///< [N] the motor's command
    double path = 0.0;       ///< [m] where the hand wants to be now
    double path_rate = 0.0;  ///< [m/s] the constant rate of `path`
  };
  /// Advances by `quanta` quanta of `tables`, 0 or more.
  void advance(const PlantTables& tables, const Inputs& inputs, std::int64_t quanta) noexcept;

  [[nodiscard]] double position() const noexcept { return state_[0]; }
  [[nodiscard]] double velocity() const noexcept { return state_[1]; }
  [[nodiscard]] double handPosition(const PlantTables& tables) const noexcept {
    return state_[tables.has_grip ? 2 : 0];
  }
  [[nodiscard]] double motorForce() const noexcept { return state_[4]; }
  [[nodiscard]] bool sticks() const noexcept { return way_ == 0; }
  [[nodiscard]] const PlantWork& work() const noexcept { return work_; }

 private:
  /// Whether friction lets go, or the device stops, during the step to `next`.
  [[nodiscard]] bool hasEvent(const PlantTables& tables, const PlantState& next,
                              double length) const noexcept;
  [[nodiscard]] double netForce(const PlantTables& tables) const noexcept;
  void setWay(const PlantTables& tables) noexcept;
  void slide(const PlantTables& tables, int way) noexcept;
  void take(const PlantStep& step, const PlantTables& tables, const PlantState& next) noexcept;

  PlantState state_{};
  PlantWork work_;
  double push_ = 0.0;     ///< [N]
  double damping_ = 0.0;  ///< [N s/m] the device's own
  int way_ = 0;  ///< direction of sliding, -1 or 1; 0: it sticks. Not used without friction.
};

}  // namespace palpate::devices
