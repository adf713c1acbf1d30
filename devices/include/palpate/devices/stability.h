#pragma once
/// The largest stiffness of a wall that a device can hold stably in a sampled loop.

#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/devices/device_model.h"
#include "palpate/devices/velocity.h"
#include "palpate/export.h"

namespace palpate::devices {

/// A closed loop without the wall. Stiffness and damping below are those at the hand: the scene's,
/// times DeviceMapping::stiffnessAtHand().
struct LoopModel {
  DeviceModel device;                  ///< at its tip
  std::optional<HandModel> hand = {};  ///< none: nobody holds the device
  double period = 1e-3;                ///< [s] from reading to reading, more than 0
  int delay = 0;                       ///< [samples] 0 or more
  VelocitySettings velocity = {};      ///< for the velocity that damping and drag depend on
};

/// A wall that is pressed and never left; or, without a stiffness, a drag.
struct WallModel {
  double stiffness = 0.0;  ///< [N/m] 0 or more
  double damping = 0.0;    ///< [N s/m] 0 or more
};

/// [1/s] The weights of the newest reading, the one before, and so on, of which a velocity is the
/// sum. For kAdaptiveWindow they are those of its longest window, which has the largest lag.
[[nodiscard]] PALPATE_EXPORT std::vector<double> velocityWeights(const VelocitySettings& settings,
                                                                 double period);

// The following describe the linear part: without friction, encoder or saturation. Exact:
// eigenvalues of the sampled loop. All of them allocate. All throw Error (kUsage, device.model,
// loop.period, loop.delay) for an impossible loop.

/// [-] The factor by which a disturbance grows in a tick: the spectral radius. Above 1: unstable.
[[nodiscard]] PALPATE_EXPORT double growthOf(const LoopModel& loop, const WallModel& wall);
/// [N/m] Up to this stiffness the loop is stable with a wall of this damping [N s/m]; 0 if it never
/// is, infinite if it always is.
[[nodiscard]] PALPATE_EXPORT double largestStiffness(const LoopModel& loop, double damping = 0.0);
/// [N s/m] Up to this drag the loop is stable if there is no wall.
[[nodiscard]] PALPATE_EXPORT double largestDamping(const LoopModel& loop);
/// [N s/m] The damping that the device needs in addition to its own for the loop to be stable; 0 if
/// it is.
[[nodiscard]] PALPATE_EXPORT double missingDamping(const LoopModel& loop, const WallModel& wall);

/// [N/m] Up to this stiffness the wall gives no more energy than the device's own damping
/// dissipates, whatever passive hand holds it: the condition of Colgate and Schenkel (Journal of
/// Robotic Systems 14(1), 1997), b > T / (2 - 2 cos wT) Re((1 - e^-jwT) H) at all w; without delay
/// 2 (b - |B|) / T. The loop's own hand is ignored; a lag of the amplifier counts as delay, which
/// is within 1 %.
[[nodiscard]] PALPATE_EXPORT double passiveStiffness(const LoopModel& loop, double damping = 0.0);

/// [N/m] Up to this stiffness Coulomb friction suppresses the motion that the steps of the encoder
/// cause, 2 f / D (Abbott and Okamura, IEEE Transactions on Robotics 21(5), 2005; Diolaiti,
/// Niemeyer, Barbagli and Salisbury, IEEE Transactions on Robotics 22(2), 2006). 0 without
/// friction, infinite without an encoder's step.
[[nodiscard]] PALPATE_EXPORT double frictionStiffness(const DeviceModel& device);

/// [m/s] Up to this speed of a tap Coulomb friction damps an oscillation that would grow in the
/// linear loop: 4 f / (pi * missingDamping()), by the describing function of friction. Infinite if
/// the linear loop is stable.
[[nodiscard]] PALPATE_EXPORT double quietSpeed(const LoopModel& loop, const WallModel& wall);

/// The limit that decides.
enum class BudgetTerm : std::uint8_t {
  kLinear,    ///< the sampled loop: mass, damping, hand, rate and delay
  kFriction,  ///< the encoder's step in relation to friction
};

/// The stiffest wall that a loop can hold, and the limits that lead to it.
struct StabilityBudget {
  /// [-] The share of the linear limit that may be used: at the limit itself oscillations do not
  /// decay.
  static constexpr double kShare = 0.8;

  double linear = 0.0;    ///< [N/m] largestStiffness()
  double passive = 0.0;   ///< [N/m] passiveStiffness()
  double friction = 0.0;  ///< [N/m] frictionStiffness()
  /// [N/m] the smaller of kShare * linear and friction
  [[nodiscard]] double stiffness() const noexcept {
    return ruledBy() == BudgetTerm::kLinear ? kShare * linear : friction;
  }
  /// The limit that stiffness() keeps.
  [[nodiscard]] BudgetTerm ruledBy() const noexcept {
    return kShare * linear <= friction ? BudgetTerm::kLinear : BudgetTerm::kFriction;
  }
};

/// The budget of walls with a damping of `damping` [N s/m].
[[nodiscard]] PALPATE_EXPORT StabilityBudget budgetOf(const LoopModel& loop, double damping = 0.0);

}  // namespace palpate::devices
