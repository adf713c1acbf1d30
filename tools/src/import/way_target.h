#pragma once
/// Finds the place in an imported scan that a needle is to reach.

#include <optional>
#include <string>

#include "import/imported_scene.h"

namespace palpate::tools {

struct WayTarget {
  std::string name;
  std::size_t region = 0;
  /// [m] The marked point; for a region the center of the voxel that is approximately deepest
  /// inside it.
  Vec3 place{0.0};
  std::optional<Vec3> entry = {};  ///< [m] where the way has to come from; not given: anywhere
};

/// `target`: a region's or a label's name, or a label; or a file of Slicer's Markups with one
/// point, or with two of which one is the entry (labeled so, or the first).
/// @throws Error (kInput) with suggestions from the scan; for a file: markups.*, or import.target
/// if it has more points than that, or a target outside the body.
[[nodiscard]] WayTarget wayTarget(const ImportedScan& scan, const std::string& target);

}  // namespace palpate::tools
