#pragma once
/// A straight way for a needle to a target in an imported scan, as the ports of its scene let it
/// through.

#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/suggested_way.h"

namespace palpate::tools {

/// A stretch of the way within one region.
struct WayPart {
  std::size_t region = 0;
  double length = 0.0;   ///< [m]
  double rupture = 0.0;  ///< [N] what it takes to get in
  double force = 0.0;    ///< [N] predicted at its end, just before the next region
};

struct NeedleWay {
  std::string target;
  Vec3 from{0.0};   ///< [m] outside of the body
  Vec3 entry{0.0};  ///< [m] where it meets the body
  Vec3 to{0.0};     ///< [m] the point of the target that is deepest in it
  /// From outside to the target. The predicted force is that of a slow needle: at the tip what the
  /// tissue's cutting takes, along the shaft what slides, and at a wall what opens it.
  std::vector<WayPart> parts;
  double peak = 0.0;  ///< [N] the largest predicted force
  /// [m] A needle this much thicker on each side would still keep clear; 0 where it passes nearer
  /// than kClearance.
  double clearance = 0.0;

  [[nodiscard]] double length() const;  ///< [m] from the entry to the target
};

/// [m] How far a way keeps from what it must not touch, where there is such a way.
inline constexpr double kClearance = 2e-3;

/// Of all straight ways from outside to the target that pass walls only where ports lead through,
/// and touch neither what is rigid nor what the table of tissues wants spared, the shortest. A way
/// that keeps kClearance goes before one that does not. `target`: a region's or label's name, or a
/// label.
/// @throws Error (kInput): no such target; every way is closed, with what closes them.
[[nodiscard]] NeedleWay needleWay(const ImportedScan& scan, const TissueTable& tissues,
                                  const std::string& target);

/// For the scene's header.
[[nodiscard]] SuggestedWay suggestedWay(const NeedleWay& way);

}  // namespace palpate::tools
