#pragma once
/// Which walls, contents and needle parameters of a scene a device can hold stably, and the
/// remedies for those that it cannot.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/devices/stability.h"
#include "palpate/export.h"
#include "palpate/scene/scene.h"

namespace palpate::devices {

/// The part of a scene through which a material is felt.
enum class FeltAs : std::uint8_t {
  kWall,     ///< wall of a region
  kSheet,    ///< open surface
  kContent,  ///< a region's content, felt by the tip
  kNeedle    ///< a region's content, felt by a needle's tip or shaft
};

/// One thing that can be felt, with the largest stiffness and damping that it ever has, at the
/// hand.
struct FeltItem {
  FeltAs kind = FeltAs::kWall;  ///< part of the scene that is felt
  std::string material;         ///< name of the material
  std::string parameter;  ///< key of the material in a scene file: "stiffness", "lattice", ...
  std::vector<std::string> places;  ///< "from | into" for walls, else names of regions or sheets
  WallModel most;                   ///< largest stiffness [N/m] and damping [N s/m], at the hand
  double length = 0.0;  ///< [m] of shaft for which `most` holds; 0: it is not about a shaft
  std::string note;     ///< how `most` follows from the scene, if it is not the parameter itself
};

/// All that the probe can feel in the `constraint` renderer: walls and sheets that it can reach,
/// contents that it can enter, and the own walls of layers that have no end and no neighbor in
/// reach. For nonlinear springs this is the steepest slope up to the device's largest force; with
/// relaxation, the spring and its Maxwell branch together; for textured walls, the larger of the
/// stiffness of pressing and of sliding; for a needle, a shaft over the whole extent of its region,
/// or of the device's workspace if the region has no end. Stiffness and damping are multiplied by
/// DeviceMapping::stiffnessAtHand(). Allocates.
[[nodiscard]] PALPATE_EXPORT std::vector<FeltItem> feltItems(const Scene& scene,
                                                             const DeviceModel& device);

/// An item together with what the loop can hold.
struct BudgetItem {
  FeltItem item;           ///< what is felt
  StabilityBudget budget;  ///< for the damping that the item has
  /// [-] The share of the budget that it uses: its stiffness, or if it has none its damping, over
  /// the permitted value; above 1 it is too much.
  double share = 0.0;
  double quiet_speed = kInfinity;  ///< [m/s] quietSpeed()

  /// [N/m] or, without stiffness, [N s/m]: the largest permitted value, at the hand.
  double allowed = 0.0;

  // Remedies, each sufficient by itself; computed only where `share` is above 1.
  double rate = kInfinity;  ///< [Hz] smallest rate that permits it; infinite: none up to 100 kHz
  /// [-] Factor on the scene's `device: {force: ...}`, or on the shaft's length; 0: none helps.
  double force = 0.0;
  std::vector<std::string> hands;  ///< presets with which it is stable, other than the loop's own
  double missing_damping = 0.0;    ///< [N s/m] missingDamping()

  /// True if the loop cannot hold the item stably.
  [[nodiscard]] bool isAbove() const noexcept { return share > 1.0; }
};

/// Items in the order of feltItems(). Set-up only: allocates, and takes some ms for each item.
/// @throws Error as largestStiffness().
[[nodiscard]] PALPATE_EXPORT std::vector<BudgetItem> sceneBudget(const Scene& scene,
                                                                 const LoopModel& loop);

}  // namespace palpate::devices
