#include "scan/keep_centers.h"

#include <algorithm>
#include <cmath>

#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

/// [steps] More than a spline through the grid's voxels is off at them.
constexpr double kOff = 0.02;
constexpr double kSamePlace = 1e-3;  // [voxels]

}  // namespace

void keepCenters(openvdb::FloatGrid& grid, const MaskedBand& layer, const Image& image,
                 const Vec3& phase, const BakePlan& plan) {
  const double step = std::min(
      {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])});
  const double units = step / plan.meters_per_unit;
  const Mask& mask = layer.mask;
  forBlocks(layer.parting.size(), [&](std::size_t b) {
    const BandBlock& block = layer.band.blocks[b];
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      if (std::isnan(block.value[n])) continue;
      const auto place = static_cast<int>(n);
      const int i = block.first[0] + (place >> 6);
      const int j = block.first[1] + (place >> 3 & 7);
      const int k = block.first[2] + (place & 7);
      const Vec3 p = image.toWorld(Vec3(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k));
      const Vec3 at = (p - phase) / plan.voxel;
      const Vec3 near = glm::round(at);
      if (glm::length(at - near) > kSamePlace) continue;
      const openvdb::Coord voxel(static_cast<int>(near.x), static_cast<int>(near.y),
                                 static_cast<int>(near.z));
      auto* const leaf = grid.tree().probeLeaf(voxel);
      if (leaf == nullptr || !leaf->isValueOn(voxel)) continue;
      const auto here = static_cast<std::size_t>(mask.at(i, j, k));
      const bool is_neighbors =
          !layer.neighbors.inside.empty() && layer.neighbors.inside[here] != 0;
      const bool is_own = mask.inside[here] != 0 && !is_neighbors;
      const auto parting = static_cast<double>(layer.parting[b][n]);
      const float value = leaf->getValue(voxel);
      const float kept = is_own ? std::min(value, static_cast<float>((parting - kOff) * units))
                                : std::max(value, static_cast<float>((parting + kOff) * units));
      if (kept != value) leaf->setValueOnly(voxel, kept);
    }
  });
}

}  // namespace palpate::vdb
