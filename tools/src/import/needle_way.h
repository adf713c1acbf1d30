#pragma once
/// Finds a straight way for a needle to a target in an imported scan, through the ports of its
/// scene.

#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/suggested_way.h"
#include "import/way_target.h"

namespace palpate::tools {

/// A segment of the way within one region.
struct WayPart {
  std::size_t region = 0;
  double length = 0.0;   ///< [m]
  double rupture = 0.0;  ///< [N] force that it takes to get in
  double force = 0.0;    ///< [N] predicted at its end, just before the next region
};

struct NeedleWay {
  std::string target;
  bool is_given = false;  ///< the user chose the entry
  Vec3 from{0.0};         ///< [m] outside the body
  Vec3 entry{0.0};        ///< [m] where it meets the body
  Vec3 to{0.0};           ///< [m] WayTarget::place, to a tenth of a millimeter
  /// From outside to the target. The predicted force is that of a slow needle: the cutting force of
  /// the tissue at the tip, friction along the part of the shaft that slides, and at a wall the
  /// force that opens it.
  std::vector<WayPart> parts;
  double peak = 0.0;  ///< [N] the largest predicted force
  /// [m] The needle could be thicker by this much on each side and would still keep clear; 0 if the
  /// way passes nearer than kClearance.
  double clearance = 0.0;

  [[nodiscard]] double length() const;  ///< [m] from the entry to the target
};

/// [m] Distance that a way keeps from forbidden tissue, if there is such a way.
inline constexpr double kClearance = 2e-3;

/// The shortest of all straight ways from outside to the target that cross walls only through
/// ports, and touch neither rigid tissue nor tissue that the table wants spared. A way that keeps
/// kClearance is preferred to others. If the target has an entry, only the way from there is tried.
/// `through_bone`: rigid tissue does not stop the needle.
/// @throws Error (kInput): every way is closed, with the regions that close them.
[[nodiscard]] NeedleWay needleWay(const ImportedScan& scan, const TissueTable& tissues,
                                  const WayTarget& target, bool through_bone = false);

/// The way in the form of the suggestion in the scene's header.
[[nodiscard]] SuggestedWay suggestedWay(const NeedleWay& way);

/// The way as a line that Slicer loads, from the entry to the target.
[[nodiscard]] std::string wayMarkups(const NeedleWay& way);

}  // namespace palpate::tools
