#pragma once
/// Whether the parts made of a label image still have the voxel centers of their labels.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// Which part has a voxel's label, or a point: an index of the caller's.
inline constexpr int kNoPart = -1;     ///< it is in none of the image's parts
inline constexpr int kOtherPart = -2;  ///< something else has the point: not looked at

struct CenterCount {
  std::uint64_t centers = 0;
  std::uint64_t changed = 0;  ///< in another part than that of their label
  /// Of the changed ones, those that no more than half of their neighbors gave reason to change:
  /// at least half of the 26 have the voxel's own part.
  std::uint64_t against = 0;
};

struct LabelCenters {
  std::map<int, CenterCount> parts;  ///< kNoPart: voxels in none that are beside a part
  CenterCount all;                   ///< of all these
  std::optional<Vec3> place;         ///< [m] of the first that changed against its neighbors
};

/// Looks at every voxel near the border of a part, two voxels away from it at most; deeper ones
/// count as unchanged. `part_of`: by label; labels that are not in it are in no part. `part_at`:
/// what a point [m] is in; called from several threads.
[[nodiscard]] LabelCenters countCenters(const Image& image, const std::map<int, int>& part_of,
                                        const std::function<int(const Vec3&)>& part_at);

}  // namespace palpate::vdb
