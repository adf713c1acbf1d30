#pragma once
/// Finds where the surface of a mask passes between two voxels.

#include <array>
#include <cmath>

#include "scan/band.h"

namespace palpate::vdb {

/// Calls visit(voxel, axis, side, value inside, value outside) for each inside voxel of a block
/// with an outside neighbor: `voxel` is a box index, and the neighbor is `side` (-1 or 1) away
/// along `axis`. Beyond the image's border the value outside is NaN.
template <typename Visit>
void forCrossings(const Band& band, const Mask& mask, const BandBlock& block, const Visit& visit) {
  const auto strides = mask.strides();
  for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
    if (std::isnan(block.value[n])) continue;
    const auto place = static_cast<int>(n);
    const std::array<int, 3> at = {block.first[0] + (place >> 6), block.first[1] + (place >> 3 & 7),
                                   block.first[2] + (place & 7)};
    const std::ptrdiff_t here = mask.at(at[0], at[1], at[2]);
    if (mask.inside[static_cast<std::size_t>(here)] == 0) continue;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      for (const int side : {-1, 1}) {
        if (mask.inside[static_cast<std::size_t>(here + side * strides[axis])] != 0) continue;
        std::array<int, 3> next = {band.first[0] + at[0], band.first[1] + at[1],
                                   band.first[2] + at[2]};
        next[axis] += side;
        visit(at, a, side, block.value[n], band.valueAt(next[0], next[1], next[2]));
      }
    }
  }
}

}  // namespace palpate::vdb
