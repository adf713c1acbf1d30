#include "scan/lattice.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr float kLargest = 1e30F;  // stands for infinite intensities; differences stay finite
constexpr float kSmallest = 1e-30F;
constexpr float kLeastLattice = 1e-3F;

/// Copies the nearest box value into the frame, positive.
void mirrorIntoFrame(const Mask& mask, std::vector<float>& values) {
  const auto copy = [&](std::ptrdiff_t to, std::ptrdiff_t from) {
    values[static_cast<std::size_t>(to)] = std::abs(values[static_cast<std::size_t>(from)]);
  };
  const auto [nx, ny, nz] = mask.box;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      copy(mask.at(-1, j, k), mask.at(0, j, k));
      copy(mask.at(nx, j, k), mask.at(nx - 1, j, k));
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int i = -1; i <= nx; ++i) {
      copy(mask.at(i, -1, k), mask.at(i, 0, k));
      copy(mask.at(i, ny, k), mask.at(i, ny - 1, k));
    }
  }
  for (int j = -1; j <= ny; ++j) {
    for (int i = -1; i <= nx; ++i) {
      copy(mask.at(i, j, -1), mask.at(i, j, 0));
      copy(mask.at(i, j, nz), mask.at(i, j, nz - 1));
    }
  }
}

}  // namespace

Lattice latticeOfThreshold(const Image& image, double above, const Mask& mask) {
  Lattice lattice{mask.first, mask.box, std::vector<float>(mask.inside.size())};
  for (int k = 0; k < mask.box[2]; ++k) {
    for (int j = 0; j < mask.box[1]; ++j) {
      for (int i = 0; i < mask.box[0]; ++i) {
        const auto n = static_cast<std::size_t>(mask.at(i, j, k));
        const float intensity = image.at(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k);
        const auto apart = static_cast<float>(std::abs(above - static_cast<double>(intensity)));
        // NaN is background; what lies across from it then decides alone where the surface is.
        const float size = std::isnan(apart) ? kSmallest : std::clamp(apart, kSmallest, kLargest);
        lattice.values[n] = mask.inside[n] != 0 ? -size : size;
      }
    }
  }
  mirrorIntoFrame(mask, lattice.values);
  return lattice;
}

Lattice latticeOf(const Band& band, const Mask& mask) {
  constexpr float kFar = 100.0F;
  Lattice lattice{mask.first, mask.box, std::vector<float>(mask.inside.size())};
  for (std::size_t n = 0; n < mask.inside.size(); ++n) {
    lattice.values[n] = mask.inside[n] != 0 ? -kFar : kFar;
  }
  for (const BandBlock& block : band.blocks) {
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      if (std::isnan(block.value[n])) continue;
      const auto place = static_cast<int>(n);
      const auto at = static_cast<std::size_t>(mask.at(block.first[0] + (place >> 6),
                                                       block.first[1] + (place >> 3 & 7),
                                                       block.first[2] + (place & 7)));
      const float size = std::max(std::fabs(block.value[n]), kLeastLattice);
      lattice.values[at] = mask.inside[at] != 0 ? -size : size;
    }
  }
  mirrorIntoFrame(mask, lattice.values);
  return lattice;
}

Band bandOfLattice(const Lattice& lattice, const Mask& mask, const Vec3& spacing) {
  Band band = bandOf(mask, spacing);
  band.bounds = {};
  float largest = 0.0F;
  for (BandBlock& block : band.blocks) {
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      if (std::isnan(block.value[n])) continue;
      const auto place = static_cast<int>(n);
      block.value[n] = lattice.values[static_cast<std::size_t>(
          mask.at(block.first[0] + (place >> 6), block.first[1] + (place >> 3 & 7),
                  block.first[2] + (place & 7)))];
      const float size = std::fabs(block.value[n]);
      if (size < kLargest) largest = std::max(largest, size);
    }
  }
  for (BandBlock& block : band.blocks) {
    for (float& value : block.value) {
      if (std::fabs(value) > largest) value = std::copysign(largest, value);
    }
  }
  return band;
}

}  // namespace palpate::vdb
