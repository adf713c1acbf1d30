#pragma once
// One axis of a device with a hand, as it moves.

#include <cstdint>

#include "plant_tables.h"

namespace palpate::devices {

/// What went where since the start, along one axis [J]. Exact up to rounding.
struct PlantWork {
  double motor = 0.0;     ///< done by the motor on the device
  double friction = 0.0;  ///< lost to Coulomb friction
  double viscous = 0.0;   ///< lost to the device's own damping
  double push = 0.0;      ///< done by the constant push
};

/// A value; real-time safe.
class PlantAxis {
 public:
  /// At rest at `x` [m], the hand too.
  void start(double x, double push, double damping) noexcept;

  struct Inputs {
    double force = 0.0;      ///< [N] the motor's command
    double path = 0.0;       ///< [m] where the hand wants to be now,
    double path_rate = 0.0;  ///< [m/s] and how that goes on
  };
  /// Goes on for `quanta` of `tables`, 0 or more.
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
  /// Whether friction lets go, or the device stops, somewhere within the step to `next`.
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
  int way_ = 0;           ///< of sliding, -1 or 1; 0: sticks. Without friction not used.
};

}  // namespace palpate::devices
