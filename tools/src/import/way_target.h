#pragma once
/// Finds the place in an imported scan that a needle is to reach.

#include <string>

#include "import/imported_scene.h"

namespace palpate::tools {

struct WayTarget {
  std::string name;
  std::size_t region = 0;
  Vec3 place{0.0};  ///< [m] the center of the voxel that is approximately deepest inside the target
};

/// `target`: a region's or a label's name, or a label.
/// @throws Error (kInput) with suggestions from the scan.
[[nodiscard]] WayTarget wayTarget(const ImportedScan& scan, const std::string& target);

}  // namespace palpate::tools
