#pragma once
/// Fills voxels that are not known from their neighbors.

#include <array>
#include <vector>

namespace palpate::vdb {

/// Every NaN among the `size` voxels (the first index running fastest) gets the mean of its known
/// neighbors across faces, ring by ring outwards. False if nothing is known.
[[nodiscard]] bool fillUnknown(const std::array<int, 3>& size, std::vector<float>& values);

}  // namespace palpate::vdb
