#pragma once
// The sampled loop of a device, a hand and a wall as one matrix.

#include <Eigen/Dense>
#include <vector>

#include "palpate/devices/stability.h"

namespace palpate::devices {

/// Units are the moving mass and the period, so that all entries are of similar size whatever the
/// device.
class ClosedLoop {
 public:
  /// @throws Error as the functions of stability.h.
  explicit ClosedLoop(const LoopModel& loop);

  /// The spectral radius.
  [[nodiscard]] double growth(const WallModel& wall) const;
  /// True if the growth is at most 1, allowing for the rounding of a loop that neither grows nor
  /// decays.
  [[nodiscard]] bool isStable(const WallModel& wall) const;

  [[nodiscard]] double unitOfStiffness() const noexcept { return mass_ / (period_ * period_); }
  [[nodiscard]] double unitOfDamping() const noexcept { return mass_ / period_; }

 private:
  Eigen::MatrixXd plant_;        ///< state transition in a tick; the device's position comes first
  Eigen::VectorXd input_;        ///< effect of a force held for a tick
  std::vector<double> weights_;  ///< of positions in the velocity estimate
  double mass_;                  ///< [kg]
  double period_;                ///< [s]
  int delay_;                    ///< [samples]
};

}  // namespace palpate::devices
