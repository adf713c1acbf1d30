#include "grid/survey.h"

#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "brick/slopes.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

constexpr std::size_t kSide = 10;  ///< a leaf and one more voxel on every side
constexpr std::size_t kStepX = kSide * kSide;
constexpr std::size_t kStepY = kSide;

/// The values around one leaf that interpolation uses.
struct Block {
  std::array<float, kSide * kSide * kSide> values;
};

void gather(const Leaf& leaf, const Accessor& accessor, float plateau, Block& block,
            Survey& survey) {
  const Coord first = leaf.origin().offsetBy(-1);
  std::size_t n = 0;
  for (int x = 0; x < static_cast<int>(kSide); ++x) {
    for (int y = 0; y < static_cast<int>(kSide); ++y) {
      for (int z = 0; z < static_cast<int>(kSide); ++z, ++n) {
        const Coord at = first.offsetBy(x, y, z);
        const bool is_own = std::min({x, y, z}) > 0 && std::max({x, y, z}) < 9;
        float value = 0.0F;
        const bool active = is_own ? leaf.probeValue(at, value) : accessor.probeValue(at, value);
        block.values[n] = active ? value : std::copysign(plateau, value);
        if (is_own && value < 0.0F) survey.inside.expand(at);
        if (is_own && active) survey.known.expand(at);
      }
    }
  }
}

struct Part {
  Survey survey;
  Block block;
  double steepest_square = 0.0;
};

}  // namespace

float plateauOf(const LevelSetInfo& info, Sampler sampler) noexcept {
  const double slack = sampler == Sampler::kCubic
                           ? 2.0 / 6.0 / std::max(info.half_width - 2.0 * std::sqrt(3.0), 1.0)
                           : 3.0 / 8.0 / (info.half_width - 0.5 * std::sqrt(3.0));
  return static_cast<float>((info.half_width - slack) * info.voxel_size / info.meters_per_unit);
}

Survey surveyGrid(const openvdb::FloatGrid& grid, float plateau) {
  tbb::enumerable_thread_specific<Part> parts;
  openvdb::tree::LeafManager<const Tree> leaves(grid.tree());
  leaves.foreach ([&](const Leaf& leaf, std::size_t) {
    Part& part = parts.local();
    gather(leaf, Accessor(grid.tree()), plateau, part.block, part.survey);
    part.steepest_square = std::max(
        part.steepest_square, steepestSquare(part.block.values.data(), kSide, {kStepX, kStepY}));
  });
  Survey all;
  double steepest_square = 0.0;
  for (const Part& part : parts) {
    all.inside.expand(part.survey.inside);
    all.known.expand(part.survey.known);
    steepest_square = std::max(steepest_square, part.steepest_square);
  }
  // The margin covers the rounding of samples.
  all.steepest = std::sqrt(steepest_square) * (1.0 + 1e-6) / grid.voxelSize().x();
  auto tiles = grid.tree().cbeginValueAll();
  tiles.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tiles; ++tiles) {
    if (*tiles < 0.0F) all.inside.expand(tiles.getBoundingBox());
    if (tiles.isValueOn()) all.known.expand(tiles.getBoundingBox());
  }
  return all;
}

}  // namespace palpate::vdb
