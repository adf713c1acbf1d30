#pragma once
/// The design of virtual couplings from what a device can hold (Adams and Hannaford, IEEE
/// Transactions on Robotics and Automation 15(3), 1999; Colgate, Stanley and Brown, IROS 1995), for
/// sampled positions and held forces.

#include "palpate/devices/stability.h"
#include "palpate/devices/virtual_coupling.h"
#include "palpate/export.h"

namespace palpate::devices {

// Of a loop these functions use the device's smallest mass and damping, the period, the delay and
// the amplifier's lag, but not the hand. All throw Error (kUsage, coupling.device) for a device
// without damping, and (kUsage) for an impossible loop.

/// [N/m] The stiffest coupling with `damping` [N s/m] that is stable with any passive scene behind
/// it and any passive hand: K_c with Re(1 / Z_c) >= (1 - cos((1 + d) w T)) / (2 b) at all w, where
/// Z_c = B_c + K_c T / (1 - exp(-j w T)). For B_c = 0 that is 2 b / (T (1 + d)^2). 0 if no
/// stiffness is stable. An amplifier's lag counts as a delay of as many ticks, rounded up.
[[nodiscard]] PALPATE_EXPORT double stiffestForAnyScene(const LoopModel& loop, double damping);

/// [N/m] The stiffest coupling that is stable with any spring behind it, as in a scene that stands
/// still: 2 sqrt(b B_c) / (T / 2 + t_d) where B_c > b, else (b + B_c) / (T / 2 + t_d), with t_d = d
/// T plus the lag. The rigid wall is not the worst case: a spring in series reduces the effective
/// damping more than the stiffness. Valid for B_c far below m / T.
[[nodiscard]] PALPATE_EXPORT double stiffestForSprings(const LoopModel& loop, double damping);

/// The stiffest coupling for any passive scene, over all dampings.
[[nodiscard]] PALPATE_EXPORT CouplingSettings couplingForAnyScene(const LoopModel& loop);

/// A coupling for walls that stand still: kMargin times stiffestForSprings(), with a damping of
/// kDampingShare m / T, or of b if that is larger.
[[nodiscard]] PALPATE_EXPORT CouplingSettings couplingForSprings(const LoopModel& loop);

inline constexpr double kCouplingMargin = 0.8;         ///< [-]
inline constexpr double kCouplingDampingShare = 0.05;  ///< [-]

/// [N/m] The stiffness that is felt at rest when a wall of `stiffness` [N/m] is touched through
/// `coupling`.
[[nodiscard]] inline double feltStiffness(double stiffness,
                                          const CouplingSettings& coupling) noexcept {
  return stiffness * coupling.stiffness / (stiffness + coupling.stiffness);
}

}  // namespace palpate::devices
