#pragma once
/// Which walls, contents and needle parameters of a scene a device can hold, and what would cure
/// those that it cannot.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/devices/stability.h"
#include "palpate/export.h"
#include "palpate/scene/scene.h"

namespace palpate::devices {

enum class FeltAs : std::uint8_t { kWall, kSheet, kContent, kNeedle };

/// One thing that is felt, as stiff and as damped as it ever gets, at the hand.
struct FeltItem {
  FeltAs kind = FeltAs::kWall;
  std::string material;
  std::string parameter;  ///< key of the material in a scene file: "stiffness", "lattice", ...
  std::vector<std::string> places;  ///< "from | into" of walls, names of regions or sheets
  WallModel most;
  double length = 0.0;  ///< [m] of shaft that `most` is of; 0: of no shaft
  std::string note;     ///< how `most` comes from the scene, where it is not the parameter itself
};

/// All that the probe can feel in the `constraint` renderer: walls and sheets that it can reach,
/// contents that it can be in, and the own walls of layers without end of which none was found to
/// be in reach. Of curved springs the steepest slope that the device's greatest force gets to; with
/// relaxation the spring and its Maxwell branch together; of textured walls the steepest of
/// pressing and sliding; of a needle the shaft over the whole extent of its region, or of the
/// device's workspace where that has no end. Stiffness and damping are times
/// DeviceMapping::stiffnessAtHand(). Allocates.
[[nodiscard]] PALPATE_EXPORT std::vector<FeltItem> feltItems(const Scene& scene,
                                                             const DeviceModel& device);

/// An item beside what the loop can hold.
struct BudgetItem {
  FeltItem item;
  StabilityBudget budget;  ///< with the damping that it has
  /// [-] Of the budget that it takes: its stiffness, or where it has none its damping, over what
  /// may be; above 1: too much.
  double share = 0.0;
  double quiet_speed = kInfinity;  ///< [m/s] quietSpeed()

  /// [N/m] or, without stiffness, [N s/m]: the most that may be, at the hand.
  double allowed = 0.0;

  // What would cure it, each by itself; found where `share` is above 1 only.
  double rate = kInfinity;  ///< [Hz] from which on it may be; infinite: none up to 100 kHz
  /// [-] The scene's `device: {force: ...}` times this, or this share of the shaft's length; 0:
  /// none helps.
  double force = 0.0;
  std::vector<std::string> hands;  ///< presets that hold it, other than the loop's own
  double missing_damping = 0.0;    ///< [N s/m] missingDamping()

  [[nodiscard]] bool isAbove() const noexcept { return share > 1.0; }
};

/// In the order of feltItems(). Set-up only: allocates, and takes some ms for each item.
/// @throws Error as largestStiffness().
[[nodiscard]] PALPATE_EXPORT std::vector<BudgetItem> sceneBudget(const Scene& scene,
                                                                 const LoopModel& loop);

}  // namespace palpate::devices
