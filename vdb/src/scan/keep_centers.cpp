#include "scan/keep_centers.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

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
constexpr double kSamePlace = 1e-3;  // [voxels] A center this near to a voxel's is the same.
constexpr double kCoarse = 1.01;     // [steps] Voxels from here on are coarse.
/// Most rounds that read the grid as splines do: between voxels whose values differ unevenly, a
/// spline has another value at a voxel than the grid, and a change at one center moves others. In
/// folds of thick slices, the hardest case, each round leaves about a third of the centers before.
constexpr int kMostRounds = 10;

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

  /// Values at the grid's voxels themselves, or, if there is a spline, its values at all centers.
  /// Returns whether a center was on the wrong side.
  bool run(const BrickField* spline) {
    std::vector<std::vector<Change>> changes(layer_.parting.size());
    std::atomic<bool> was_wrong{false};
    forBlocks(changes.size(), [&](std::size_t b) {
      const BandBlock& block = layer_.band.blocks[b];
      for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
        if (!std::isnan(block.value[n])) look(b, n, spline, changes[b], was_wrong);
      }
    });
    // One after another, because centers between voxels have voxels in common.
    auto to = grid_.getAccessor();
    for (const std::vector<Change>& block : changes) {
      for (const auto& [voxel, by] : block) to.setValueOnly(voxel, to.getValue(voxel) + by);
    }
    return was_wrong.load();
  }

 private:
  struct Change {
    openvdb::Coord voxel;
    float by = 0.0F;  ///< [units of the grid]
  };

  /// The voxels around a place, and their weights in a linear interpolation.
  struct Corners {
    std::array<openvdb::Coord, 8> voxels;
    std::array<double, 8> weights{};
    std::size_t count = 0;
    double squares = 0.0;  ///< sum of the weights' squares
  };

  /// `at` [voxels].
  static Corners cornersOf(const Vec3& at) {
    const Vec3 first = glm::floor(at + kSamePlace);
    Vec3 share = at - first;
    for (int axis = 0; axis < 3; ++axis) {
      if (share[axis] < kSamePlace) share[axis] = 0.0;
    }
    Corners out;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      openvdb::Coord voxel;
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_upper = (corner >> axis & 1) != 0;
        weight *= is_upper ? share[axis] : 1.0 - share[axis];
        voxel[axis] = static_cast<int>(first[axis]) + (is_upper ? 1 : 0);
      }
      if (weight == 0.0) continue;
      out.voxels[out.count] = voxel;
      out.weights[out.count++] = weight;
      out.squares += weight * weight;
    }
    return out;
  }

  void look(std::size_t b, std::size_t n, const BrickField* spline, std::vector<Change>& out,
            std::atomic<bool>& was_wrong) const {
    const Mask& mask = layer_.mask;
    const BandBlock& block = layer_.band.blocks[b];
    const auto place = static_cast<int>(n);
    const int i = block.first[0] + (place >> 6);
    const int j = block.first[1] + (place >> 3 & 7);
    const int k = block.first[2] + (place & 7);
    const Vec3 p = image_.toWorld(Vec3(mask.first[0] + i, mask.first[1] + j, mask.first[2] + k));
    const Vec3 at = (p - phase_) / voxel_;
    const Corners corners = cornersOf(at);
    // Coarse voxels cannot hold every center between them.
    if (corners.count > 1 && (spline == nullptr || voxel_ > kCoarse * step_)) return;
    double value = 0.0;
    for (std::size_t c = 0; c < corners.count; ++c) {
      const auto* const leaf = grid_.tree().probeConstLeaf(corners.voxels[c]);
      if (leaf == nullptr || !leaf->isValueOn(corners.voxels[c])) return;
      value += corners.weights[c] * static_cast<double>(leaf->getValue(corners.voxels[c]));
    }
    const auto here = static_cast<std::size_t>(mask.at(i, j, k));
    const bool is_neighbors =
        !layer_.neighbors.inside.empty() && layer_.neighbors.inside[here] != 0;
    const double side = mask.inside[here] != 0 && !is_neighbors ? -1.0 : 1.0;
    const auto parting = static_cast<double>(layer_.parting[b][n]);
    double found = value / units_;
    if (side * (found - parting) > kNear) return;
    if (spline != nullptr) {
      const FieldSample sample = spline->sample(at * voxel_);
      if (!sample.in_band) return;
      found = sample.value / step_;
    }
    const double lacking = kOff - side * (found - parting);
    if (!(lacking > 0.0)) return;
    if (lacking > kOff) was_wrong.store(true, std::memory_order_relaxed);
    for (std::size_t c = 0; c < corners.count; ++c) {
      const double by = side * lacking * units_ * corners.weights[c] / corners.squares;
      out.push_back({corners.voxels[c], static_cast<float>(by)});
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
  (void)keeper.run(nullptr);
  bool is_wrong = true;
  for (int round = 0; round < kMostRounds && is_wrong; ++round) {
    const BrickField spline(makeLevelSet(grid, length_unit), Sampler::kCubic);
    is_wrong = keeper.run(&spline);
  }
}

}  // namespace palpate::vdb
