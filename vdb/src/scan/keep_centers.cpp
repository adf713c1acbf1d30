#include "scan/keep_centers.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "brick/brick_field.h"
#include "palpate/vdb/openvdb_access.h"
#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

/// [steps] How far centers keep off the value at which layers part: more than rounding, and so
/// little that it is not felt in the normals.
constexpr double kOff = 0.005;
/// [steps] Centers whose values are farther off than this are on their side in any spline.
constexpr double kNear = 0.5;
constexpr double kSamePlace = 1e-3;  // [voxels]
/// Rounds that read the grid as splines do: between voxels whose values differ unevenly, a spline
/// has another value at a voxel than the grid.
constexpr int kRounds = 2;

class Keeper {
 public:
  Keeper(openvdb::FloatGrid& grid, const MaskedBand& layer, const Image& image, const Vec3& phase,
         const BakePlan& plan)
      : grid_(grid),
        layer_(layer),
        image_(image),
        phase_(phase),
        voxel_(plan.voxel),
        step_(std::min(
            {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])})),
        units_(step_ / plan.meters_per_unit) {}

  /// Values at the centers themselves, or, if there is a spline, its values at them.
  void run(const BrickField* spline) {
    forBlocks(layer_.parting.size(), [&](std::size_t b) {
      const BandBlock& block = layer_.band.blocks[b];
      for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
        if (!std::isnan(block.value[n])) keep(b, n, spline);
      }
    });
  }

 private:
  void keep(std::size_t b, std::size_t n, const BrickField* spline) {
    const Mask& mask = layer_.mask;
    const BandBlock& block = layer_.band.blocks[b];
    const auto place = static_cast<int>(n);
    const int i = block.first[0] + (place >> 6);
    const int j = block.first[1] + (place >> 3 & 7);
    const int k = block.first[2] + (place & 7);
    const Vec3 p = image_.toWorld(Vec3(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k));
    const Vec3 at = (p - phase_) / voxel_;
    const Vec3 near = glm::round(at);
    if (glm::length(at - near) > kSamePlace) return;
    const openvdb::Coord voxel(static_cast<int>(near.x), static_cast<int>(near.y),
                               static_cast<int>(near.z));
    auto* const leaf = grid_.tree().probeLeaf(voxel);
    if (leaf == nullptr || !leaf->isValueOn(voxel)) return;
    const auto here = static_cast<std::size_t>(mask.at(i, j, k));
    const bool is_neighbors =
        !layer_.neighbors.inside.empty() && layer_.neighbors.inside[here] != 0;
    const double side = mask.inside[here] != 0 && !is_neighbors ? -1.0 : 1.0;
    const auto parting = static_cast<double>(layer_.parting[b][n]);
    const auto value = static_cast<double>(leaf->getValue(voxel));
    double found = value / units_;
    if (side * (found - parting) > kNear) return;
    if (spline != nullptr) {
      const FieldSample sample = spline->sample(near * voxel_);
      if (!sample.in_band) return;
      found = sample.value / step_;
    }
    const double lacking = kOff - side * (found - parting);
    if (lacking > 0.0) {
      leaf->setValueOnly(voxel, static_cast<float>(value + side * lacking * units_));
    }
  }

  openvdb::FloatGrid& grid_;
  const MaskedBand& layer_;
  const Image& image_;
  Vec3 phase_;
  double voxel_;
  double step_;   ///< [m]
  double units_;  ///< [units of the grid] a step
};

}  // namespace

void keepCenters(const openvdb::FloatGrid::Ptr& grid, const MaskedBand& layer, const Image& image,
                 const Vec3& phase, const BakePlan& plan, const std::string& length_unit) {
  if (layer.parting.empty()) return;
  Keeper keeper(*grid, layer, image, phase, plan);
  keeper.run(nullptr);
  for (int round = 0; round < kRounds; ++round) {
    const BrickField spline(makeLevelSet(grid, length_unit), Sampler::kCubic);
    keeper.run(&spline);
  }
}

}  // namespace palpate::vdb
