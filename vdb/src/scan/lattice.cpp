#include "scan/lattice.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr float kLargest = 1e30F;  // replaces infinite intensities, so that differences stay finite
constexpr float kSmallest = 1e-30F;

}  // namespace

Band bandOfThreshold(const Image& image, double above, const Mask& mask, const Vec3& spacing) {
  Band band = bandOf(mask, spacing);
  band.dropBounds();
  float largest = 0.0F;
  for (BandBlock& block : band.blocks) {
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      if (std::isnan(block.value[n])) continue;
      const auto place = static_cast<int>(n);
      const float intensity = image.at(mask.first[0] + block.first[0] + (place >> 6),
                                       mask.first[1] + block.first[1] + (place >> 3 & 7),
                                       mask.first[2] + block.first[2] + (place & 7));
      const auto apart = static_cast<float>(std::abs(above - static_cast<double>(intensity)));
      // NaN is background; the voxel on the other side alone then decides where the surface is.
      const float size = std::isnan(apart) ? kSmallest : std::clamp(apart, kSmallest, kLargest);
      if (size < kLargest) largest = std::max(largest, size);
      block.value[n] = std::copysign(size, block.value[n]);
    }
  }
  // Infinite values become as large as the largest finite one.
  for (BandBlock& block : band.blocks) {
    for (float& value : block.value) {
      if (std::fabs(value) > largest) value = std::copysign(largest, value);
    }
  }
  return band;
}

}  // namespace palpate::vdb
