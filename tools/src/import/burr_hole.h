#pragma once
/// A hole that is drilled through the bone of an imported scan, along a way that a needle is to
/// take.

#include <cstdint>
#include <string>

#include "import/imported_scene.h"
#include "import/needle_way.h"

namespace palpate::tools {

/// Voxels of rigid tissue whose centers are within `radius` [m] of the line from the way's entry to
/// its target become a new region, filled with the table's fluid. The hole ends at the target,
/// whose own region stays as it is. The scan's survey does not match its plan any more.
/// @throws Error (kInput): the way meets no bone; the table has no fluid; no label is free.
[[nodiscard]] BurrHole drill(ImportedScan& scan, const TissueTable& tissues, const NeedleWay& way,
                             const WayTarget& target, double radius);

}  // namespace palpate::tools
