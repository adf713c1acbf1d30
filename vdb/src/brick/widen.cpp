// Widens the band of a grid that is too narrow for the cubic spline.
//
// First layer by layer: each new voxel takes the nearest of the surface points that its neighbors
// know, as in the vector distance transform; the old voxels know theirs from value and gradient.
// Then in rounds: a spline is put through the band so far, and each new voxel searches for the
// closest point on its zero set by Newton's method. Near the surface the spline depends little on
// new voxels, so that a round reduces the error to a few hundredths.

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "brick/brick_field.h"
#include "brick/voxel_feet.h"
#include "palpate/core/text.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Mask = openvdb::MaskTree;
using Values = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;
using OffsetsOf = openvdb::tree::ValueAccessor<const Offsets, /*IsSafe=*/false>;
using Known = openvdb::tree::ValueAccessor<const Mask, /*IsSafe=*/false>;

/// [voxels] The spline at the surface depends on voxels up to 4.9 off; farther ones do not affect
/// it.
constexpr double kLeastWorkWidth = 5.5;
constexpr int kRounds = 3;
constexpr double kSamePlace = 0.75;  ///< [voxels] a larger correction leads to another place
constexpr int kNewtonSteps = 12;
/// [voxels] A larger difference means an edge: a smooth surface bends by less
constexpr double kSmooth = 0.3;

Vec3 vec(const Coord& at) { return {at.x(), at.y(), at.z()}; }

/// All lengths in voxels, positions as voxel coordinates.
class Widening {
 public:
  Widening(const LevelSet& grid, double half_width, const Progress& progress)
      : source_(grid),
        half_width_(half_width),
        work_width_(std::max(half_width, kLeastWorkWidth)),
        progress_(progress),
        units_per_voxel_(grid.info().voxel_size / grid.info().meters_per_unit),
        grid_(copyOf(*grid.impl().grid)),
        tree_(grid_->tree()),
        old_(tree_, false, true, openvdb::TopologyCopy()),
        offsets_(tree_, openvdb::Vec3f(0.0F), openvdb::TopologyCopy()) {}

  LevelSet run() {
    findVoxelFeet(tree_, units_per_voxel_, offsets_);
    const int layers = static_cast<int>(std::ceil(work_width_ - source_.info().half_width)) + 3;
    for (int layer = 0; layer < layers; ++layer) {
      report(progress_, "widen the band", 0.3 * layer / layers);
      if (!grow()) break;
    }
    for (int round = 0; round < kRounds; ++round) {
      report(progress_, "widen the band", 0.3 + 0.7 * round / kRounds);
      refine();
    }
    for (int layer = 0; layer < layers; ++layer) lower();
    report(progress_, "widen the band", 1.0);
    return finish();
  }

 private:
  static openvdb::FloatGrid::Ptr copyOf(const openvdb::FloatGrid& grid) {
    openvdb::FloatGrid::Ptr copy = grid.deepCopy();
    copy->tree().voxelizeActiveTiles();
    return copy;
  }

  /// Runs body(leaf of the values, leaf of the offsets) in parallel.
  template <typename Body>
  void forLeaves(const Body& body) {
    openvdb::tree::LeafManager<Tree> leaves(tree_);
    leaves.foreach ([&](Leaf& leaf, std::size_t) {
      Offsets::LeafNodeType* const offsets = offsets_.probeLeaf(leaf.origin());
      if (offsets != nullptr) body(leaf, *offsets);
    });
  }

  /// The voxels whose surface point is known.
  [[nodiscard]] Mask knownVoxels() const {
    Mask known(tree_, false, true, openvdb::TopologyCopy());
    openvdb::tree::LeafManager<Mask> leaves(known);
    leaves.foreach ([&](Mask::LeafNodeType& leaf, std::size_t) {
      const Offsets::LeafNodeType* const offsets = offsets_.probeConstLeaf(leaf.origin());
      for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        if (offsets->getValue(voxel.pos()).x() >= kNoFoot) leaf.setValueOff(voxel.pos());
      }
    });
    return known;
  }

  /// Adds one layer. False if there is nothing to add.
  bool grow() {
    const Mask known = knownVoxels();
    openvdb::tools::dilateActiveValues(tree_, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                       openvdb::tools::IGNORE_TILES);
    offsets_.topologyUnion(tree_);
    tbb::enumerable_thread_specific<bool> grew(false);
    forLeaves([&](Leaf& leaf, Offsets::LeafNodeType& offsets) {
      const Known is_known(known), is_old(old_);
      const OffsetsOf feet(offsets_);
      for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        const Coord at = voxel.getCoord();
        if (is_known.isValueOn(at)) continue;
        const Vec3 offset = firstGuess(is_known, feet, at);
        const double distance = glm::length(offset);
        offsets.setValueOnly(voxel.pos(), toVdb(offset));
        if (is_old.isValueOn(at)) {
          grew.local() |= distance < kNoFoot;
          continue;
        }
        leaf.setValueOnly(voxel.pos(), std::copysign(toUnits(distance), *voxel));
        if (distance > work_width_ + 1.0) {
          leaf.setValueOff(voxel.pos());
        } else {
          grew.local() = true;
        }
      }
    });
    return grew.combine([](bool a, bool b) { return a || b; });
  }

  /// From a voxel towards the surface: straight to the tangent plane at the nearest of the
  /// neighbors' surface points. Taking that point itself would drag it along, layer after layer.
  static Vec3 firstGuess(const Known& is_known, const OffsetsOf& feet, const Coord& at) {
    Vec3 nearest(kNoFoot);
    Vec3 normal(0.0);
    for (int n = 0; n < 27; ++n) {
      const Coord step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
      if (!is_known.isValueOn(at + step)) continue;
      const openvdb::Vec3f& stored = feet.getValue(at + step);
      const Vec3 foot(stored.x(), stored.y(), stored.z());
      const Vec3 offset = vec(step) + foot;
      if (glm::dot(offset, offset) < glm::dot(nearest, nearest)) {
        nearest = offset;
        normal = foot;
      }
    }
    const double square = glm::dot(normal, normal);
    if (!(square > 0.01)) return nearest;
    const Vec3 straight = normal * (glm::dot(normal, nearest) / square);
    // The plane is much nearer than the point: the surface ends there in an edge, and the point
    // stays the nearest.
    return glm::length(nearest) - glm::length(straight) < kSmooth ? straight : nearest;
  }

  [[nodiscard]] float toUnits(double voxels) const {
    return static_cast<float>(voxels * units_per_voxel_);
  }

  /// Recomputes every new voxel from the spline through all voxels so far.
  void refine() {
    auto band = openvdb::FloatGrid::create(tree_.background());
    band->setTransform(grid_->transformPtr());
    band->setTree(grid_->treePtr());
    const BrickField spline(makeLevelSet(band, source_.info().length_unit), Sampler::kCubic);
    const Vec3 origin = source_.impl().origin;
    const double voxel_size = source_.info().voxel_size;
    forLeaves([&](Leaf& leaf, Offsets::LeafNodeType& offsets) {
      const Known is_old(old_);
      for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        const Coord at = voxel.getCoord();
        if (is_old.isValueOn(at)) continue;
        const openvdb::Vec3f& stored = offsets.getValue(voxel.pos());
        const Vec3 guess(stored.x(), stored.y(), stored.z());
        const Vec3 x = origin + voxel_size * vec(at);
        const Vec3 offset = closestPoint(spline, x, x + voxel_size * guess) / voxel_size;
        const double distance = glm::length(offset);
        // A step that does not converge, or that leads to another part of the surface, adds
        // nothing.
        if (!(std::abs(distance - glm::length(guess)) < kSamePlace)) continue;
        offsets.setValueOnly(voxel.pos(), toVdb(offset));
        leaf.setValueOnly(voxel.pos(), std::copysign(toUnits(distance), *voxel));
      }
    });
  }

  /// Vector from x to the closest point q of the spline's zero set around `start` [m]; NaN if there
  /// is none. Newton's method for q + m grad S(q) = x and S(q) = 0.
  static Vec3 closestPoint(const BrickField& spline, const Vec3& x, const Vec3& start) {
    Vec3 q = start;
    const double enough = 1e-9 * spline.featureSize();
    const double longest = 0.5 * spline.featureSize();
    for (int step = 0; step < kNewtonSteps; ++step) {
      const FieldJet jet = spline.jet(q);
      const double square = glm::dot(jet.gradient, jet.gradient);
      if (!jet.in_band || !(square > 0.01)) break;
      const double m = glm::dot(x - q, jet.gradient) / square;
      const Mat3 bent = Mat3(1.0) + m * jet.hessian;
      if (!(std::abs(glm::determinant(bent)) > 1e-3)) break;
      const Mat3 inverse = glm::inverse(bent);
      const Vec3 rest = inverse * (x - q - m * jet.gradient);
      const Vec3 along = inverse * jet.gradient;
      const double slope = glm::dot(jet.gradient, along);
      if (!(std::abs(slope) > 1e-3)) break;
      const Vec3 move = rest - along * ((jet.value + glm::dot(jet.gradient, rest)) / slope);
      const double length = glm::length(move);
      if (!std::isfinite(length)) break;
      q += move * std::min(1.0, longest / length);
      if (length < enough) return q - x;
    }
    return Vec3(std::nan(""));
  }

  /// A distance changes by no more than the length of the step. On the outside of a sharp edge a
  /// guess may be wrong, but it must not exceed what the neighbors allow: otherwise contact would
  /// leap into the wall.
  void lower() {
    const Tree before(tree_);
    forLeaves([&](Leaf& leaf, Offsets::LeafNodeType&) {
      const Known is_old(old_);
      const Values values(before);
      for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        const Coord at = voxel.getCoord();
        if (is_old.isValueOn(at)) continue;
        float most = std::fabs(*voxel);
        for (int n = 0; n < 27; ++n) {
          const Coord step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
          float near = 0.0F;
          if (!values.probeValue(at + step, near) || near * *voxel <= 0.0F) continue;
          most = std::min(most, std::fabs(near) + toUnits(glm::length(vec(step))));
        }
        leaf.setValueOnly(voxel.pos(), std::copysign(most, *voxel));
      }
    });
  }

  LevelSet finish() {
    const float background = toUnits(half_width_);
    forLeaves([&](Leaf& leaf, Offsets::LeafNodeType&) {
      const Known is_old(old_);
      for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
        if (std::fabs(*voxel) >= background && !is_old.isValueOn(voxel.getCoord())) {
          leaf.setValueOff(voxel.pos());
        }
      }
    });
    openvdb::tools::changeLevelSetBackground(tree_, background);
    openvdb::tools::pruneLevelSet(tree_);
    grid_->insertMeta("palpate:widened", openvdb::StringMetadata("from " + oldWidth()));
    return makeLevelSet(grid_, source_.info().length_unit);
  }

  [[nodiscard]] std::string oldWidth() const {
    return shortNumber(source_.info().half_width, 6) + " voxels";
  }

  const LevelSet& source_;
  double half_width_;
  double work_width_;
  const Progress& progress_;
  double units_per_voxel_;
  openvdb::FloatGrid::Ptr grid_;
  Tree& tree_;
  Mask old_;         ///< the voxels of the old band, which keep their values
  Offsets offsets_;  ///< [voxels] from each active voxel to its closest point of the surface
};

}  // namespace

LevelSet widened(const LevelSet& grid, double half_width, const Progress& progress) {
  const LevelSetInfo& info = grid.info();
  if (!(half_width <= 1000.0)) {
    throw inputError("bake.half_width", "a band of " + std::to_string(half_width) +
                                            " voxels is asked for; it may have up to 1000");
  }
  // The float of the background may be a little below the width that was asked for.
  if (!(info.half_width < half_width - 1e-3)) return grid;
  if (info.half_width < 2.0) {
    throw inputError("vdb.narrow", "the band of grid '" + info.name + "' is " +
                                       std::to_string(info.half_width) +
                                       " voxels wide on each side; at least 2 are needed");
  }
  return Widening(grid, half_width, progress).run();
}

}  // namespace palpate::vdb
