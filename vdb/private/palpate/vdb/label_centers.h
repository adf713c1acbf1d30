#pragma once
/// Counts the voxel centers of a label image that are in another part than their label's.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// The caller numbers the parts from 0. These stand for places outside them:
inline constexpr int kNoPart = -1;     ///< in none of the image's parts
inline constexpr int kOtherPart = -2;  ///< in a part of something else: not looked at

struct CenterCount {
  std::uint64_t centers = 0;
  std::uint64_t changed = 0;  ///< in another part than that of their label
  /// The changed ones of which at least half of the 26 neighbors have the voxel's own part.
  std::uint64_t against = 0;
};

struct LabelCenters {
  std::map<int, CenterCount> parts;  ///< by part; kNoPart: voxels in none that are beside a part
  CenterCount all;                   ///< the sum
  std::optional<Vec3> place;         ///< [m] of the first that changed against its neighbors
};

/// Looks at every voxel that is at most two voxels away from the border of a part; deeper ones
/// count as unchanged. `part_of`: the part of each label; a label without an entry is in no part.
/// `part_at`: gives the part at a point [m]; called from several threads.
[[nodiscard]] LabelCenters countCenters(const Image& image, const std::map<int, int>& part_of,
                                        const std::function<int(const Vec3&)>& part_at);

}  // namespace palpate::vdb
