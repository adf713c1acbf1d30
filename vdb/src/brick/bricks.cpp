#include "brick/bricks.h"

#include <openvdb/tree/ValueAccessor.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "brick/block_map.h"
#include "brick/least_way.h"
#include "brick/prefilter.h"
#include "brick/slopes.h"
#include "grid/survey.h"
#include "huge_vector.h"
#include "palpate/core/error.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

/// Three blocks in a row along z, as leaves or tiles.
struct BlockRow {
  std::array<const float*, 3> values{};  ///< a leaf's 512 voxels; null: a tile
  std::array<const Leaf::NodeMaskType*, 3> masks{};
  std::array<float, 3> tiles{};  ///< the value of a tile
};

BlockRow blockRowAt(const Accessor& accessor, const Coord& middle) {
  BlockRow row;
  for (std::size_t n = 0; n < 3; ++n) {
    const Coord at = middle.offsetBy(0, 0, 8 * (static_cast<int>(n) - 1));
    const Leaf* const leaf = accessor.probeConstLeaf(at);
    if (leaf == nullptr) {
      row.tiles[n] = accessor.getValue(at);
    } else {
      row.values[n] = leaf->buffer().data();
      row.masks[n] = &leaf->getValueMask();
    }
  }
  return row;
}

/// Copies `kCount` voxels of block `kBlock` from `kFirst` on.
template <std::size_t kBlock, unsigned kFirst, unsigned kCount>
unsigned gatherPart(const BlockRow& row, unsigned x, unsigned y, float* to) {
  const float* const values = row.values[kBlock];
  if (values == nullptr) {
    std::fill_n(to, kCount, row.tiles[kBlock]);
    return 0;
  }
  std::copy_n(values + (x * 64 + y * 8 + kFirst), kCount, to);
  const auto word = row.masks[kBlock]->getWord<openvdb::Index64>(x);  // a byte for each y
  return static_cast<unsigned>(word >> (8 * y + kFirst)) & ((1U << kCount) - 1U);
}

/// Copies the voxels of a neighborhood's row along z: the last three of the first block, all of the
/// second, and the first four of the last. `x` and `y` count within the blocks. Returns a bit for
/// each voxel that is known.
unsigned gatherRow(const BlockRow& row, unsigned x, unsigned y, float* to) {
  return gatherPart<0, 5, 3>(row, x, y, to) | gatherPart<1, 0, 8>(row, x, y, to + 3) << 3 |
         gatherPart<2, 0, 4>(row, x, y, to + 11) << 11;
}

/// Copies values and topology around a block, from the leaves and tiles there.
void gather(const Accessor& accessor, const Coord& block, Neighborhood& to) {
  const Coord first = block << 3;
  std::array<std::array<BlockRow, 3>, 3> blocks;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      blocks[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          blockRowAt(accessor, first.offsetBy(8 * (i - 1), 8 * (j - 1), 0));
    }
  }
  constexpr unsigned kFirst = 8 + Neighborhood::kFirst;  // counted from the block before
  for (unsigned x = 0; x < Neighborhood::kSide; ++x) {
    for (unsigned y = 0; y < Neighborhood::kSide; ++y) {
      const BlockRow& row = blocks[(kFirst + x) >> 3][(kFirst + y) >> 3];
      float* const values = to.values.data() + (x * Neighborhood::kSlab + y * Neighborhood::kRow);
      to.known[x * Neighborhood::kSide + y] =
          static_cast<std::uint16_t>(gatherRow(row, (kFirst + x) & 7U, (kFirst + y) & 7U, values));
    }
  }
}

/// Results that one thread collects while it makes bricks.
struct Part {
  Neighborhood neighborhood;
  double steepest_square = 0.0;
  /// [square of the slope] Bound for the last brick made, from its coefficients
  double last_square = 0.0;
  CoordBBox negative;
  BandBounds bounds;
};

void expandByNegative(const Brick& brick, const Coord& block, CoordBBox& negative) {
  if (negative.isInside(CoordBBox::createCube(block << 3, Brick::kSide))) return;
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      for (int z = 0; z < Brick::kSide; ++z) {
        if (brick.values[Brick::at(x, y, z)] < 0.0F) {
          negative.expand((block << 3).offsetBy(x, y, z));
        }
      }
    }
  }
}

/// [voxels per voxel]^2 Bound of the squared slope over all cells of the brick.
double steepestSquareIn(const Brick& brick, bool cubic) noexcept {
  const int first = cubic ? -1 : 0;
  const std::size_t side = cubic ? 11 : 9;
  return steepestSquare(brick.values + Brick::at(first, first, first), side,
                        {Brick::kSlab, Brick::kRow});
}

/// The voxels of all cells in the box, limited to numbers that 32 bits hold.
CoordBBox voxelsOf(const Box3& box, const LevelSet& grid) {
  constexpr double kFarthest = 1 << 29;
  const auto at = [&](const Vec3& p, double by) {
    const Vec3 q = glm::clamp((p - grid.impl().origin) / grid.info().voxel_size + by,
                              Vec3(-kFarthest), Vec3(kFarthest));
    return Coord(static_cast<int>(std::floor(q.x)), static_cast<int>(std::floor(q.y)),
                 static_cast<int>(std::floor(q.z)));
  };
  // The margin covers the rounding of places.
  return {at(box.lo, -1.0), at(box.hi, 1.0)};
}

/// Makes bricks, one after another on each thread.
class BrickMaker {
 public:
  BrickMaker(const LevelSet& grid, Sampler sampler)
      : cubic_(sampler == Sampler::kCubic),
        plateau_(plateauOf(grid.info(), sampler)),
        units_per_voxel_(grid.info().voxel_size / grid.info().meters_per_unit),
        tree_(grid.impl().grid->constTreePtr()) {
    if (!tree_->hasActiveTiles()) return;
    const openvdb::FloatTree::Ptr copy(new openvdb::FloatTree(*tree_));
    copy->voxelizeActiveTiles();
    tree_ = copy;
  }

  [[nodiscard]] const Tree& tree() const noexcept { return *tree_; }
  [[nodiscard]] float plateau() const noexcept { return plateau_; }

  /// Calls body(n, accessor, part) for each n below `count`, in parallel.
  template <typename Body>
  void forAll(std::size_t count, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
      Part& part = parts_.local();
      const Accessor accessor(*tree_);
      for (std::size_t n = range.begin(); n != range.end(); ++n) body(n, accessor, part);
    });
  }

  void make(const Coord& block, const Accessor& accessor, Part& part, Brick& brick) const {
    gather(accessor, block, part.neighborhood);
    (cubic_ ? fillCubic : fillLinear)(part.neighborhood, plateau_, units_per_voxel_, brick);
    part.last_square = steepestSquareIn(brick, cubic_);
    double square = part.last_square;
    // Look cell by cell only where the brick could hold the steepest slope of all. A brick that is
    // skipped could not, in whatever order bricks are made.
    if (cubic_ && square > std::max(kNotSteep * kNotSteep, part.steepest_square)) {
      const double slope = steepestInCells(brick);
      square = std::min(square, slope * slope);
    }
    part.steepest_square = std::max(part.steepest_square, square);
  }

  /// Bound over all bricks made. The slope of a distance is 1, though a grid whose surface is flat
  /// may have less. The margin covers the rounding of samples.
  [[nodiscard]] double lipschitz() const {
    double steepest_square = 0.0;
    for (const Part& part : parts_) {
      steepest_square = std::max(steepest_square, part.steepest_square);
    }
    return std::max(1.0, std::sqrt(steepest_square) * (1.0 + 1e-6));
  }
  [[nodiscard]] const tbb::enumerable_thread_specific<Part>& parts() const noexcept {
    return parts_;
  }
  [[nodiscard]] bool cubic() const noexcept { return cubic_; }

 private:
  bool cubic_;
  float plateau_;
  double units_per_voxel_;
  openvdb::FloatTree::ConstPtr tree_;
  tbb::enumerable_thread_specific<Part> parts_;
};

void requireBrickMemory(double bytes, std::uint64_t max_memory, const std::string& name) {
  if (max_memory == 0 || bytes <= static_cast<double>(max_memory)) return;
  throw Error(ErrorKind::kOperation,
              {"bricks.memory",
               "grid '" + name + "' needs " + inGigabytes(bytes) + " for its bricks, " +
                   inGigabytes(static_cast<double>(max_memory)) + " are allowed",
               "use larger voxels, or sampler: accessor, which reads the grid itself"});
}

}  // namespace

void Bricks::Release::operator()(std::byte* memory) const noexcept { std::free(memory); }

std::uint64_t Bricks::memory() const noexcept {
  return count_ * sizeof(Brick) + (blocks_.size() + coarse_.size()) * sizeof(std::uint32_t);
}

Bricks::Bricks(const LevelSet& grid, Sampler sampler, const Box3& within,
               std::uint64_t max_memory) {
  const LevelSetInfo& info = grid.info();
  BrickMaker maker(grid, sampler);
  const Tree& tree = maker.tree();
  BlockMap map = mapBlocks(tree);
  if (within.isBounded()) map = cutTo(voxelsOf(within, grid), map);
  count_ = map.bricks.size();
  requireBrickMemory(static_cast<double>(count_ * sizeof(Brick)), max_memory, info.name);
  BlockTable table = makeTable(tree, map);
  // Huge pages: a cold query of a brick then costs no walk through page tables on top.
  bricks_.reset(static_cast<std::byte*>(allocateHuge(count_ * sizeof(Brick), alignof(Brick))));
  maker.forAll(count_, [&](std::size_t n, const Accessor& accessor, Part& part) {
    Brick& brick = *new (bricks_.get() + n * sizeof(Brick)) Brick;
    maker.make(map.bricks[n], accessor, part, brick);
    expandByNegative(brick, map.bricks[n], part.negative);
  });
  lipschitz_ = maker.lipschitz();
  CoordBBox negative = map.inside_tiles;
  for (const Part& part : maker.parts()) negative.expand(part.negative);

  const auto position = [&](const Coord& at) {
    return grid.impl().origin + info.voxel_size * Vec3(at.x(), at.y(), at.z());
  };
  // A cell has negative values only if one of its voxels is negative.
  const int reach = maker.cubic() ? 2 : 1;
  if (!negative.empty()) {
    bounds_ = {position(negative.min().offsetBy(-reach)), position(negative.max().offsetBy(reach))};
  }
  blocks_ = std::move(table.blocks);
  coarse_ = std::move(table.coarse);
  view_.bricks = bricks_.get();
  view_.blocks = blocks_.data();
  view_.coarse = coarse_.empty() ? nullptr : coarse_.data();
  view_.stride_x = table.stride_x;
  view_.stride_y = table.stride_y;
  view_.origin = position(table.box.min() << 3);
  view_.per_voxel = 1.0 / info.voxel_size;
  view_.voxel = info.voxel_size;
  const Coord size = table.box.dim();
  view_.shift = -view_.origin * view_.per_voxel - 0.5;
  for (int axis = 0; axis < 3; ++axis)
    view_.size[axis] = 8 * static_cast<std::uint64_t>(size[axis]);
  view_.plateau = maker.plateau() * info.meters_per_unit;
}

BrickSurvey surveyBricks(const LevelSet& grid, Sampler sampler, double least_within) {
  BrickMaker maker(grid, sampler);
  const BlockMap map = mapBlocks(maker.tree());
  maker.forAll(map.bricks.size(), [&](std::size_t n, const Accessor& accessor, Part& part) {
    Brick brick;
    maker.make(map.bricks[n], accessor, part, brick);
    const Coord first = map.bricks[n] << 3;
    part.bounds.add(brick, {first.x(), first.y(), first.z()}, maker.cubic(),
                    std::sqrt(part.last_square));
  });
  BrickSurvey survey;
  for (const Part& part : maker.parts()) survey.bounds.add(part.bounds);
  survey.lipschitz = maker.lipschitz();
  if (survey.bounds.within() >= least_within) return survey;
  // Holes and plates as thin as a voxel are steep, and weaken that bound for the whole grid:
  // compute it again, only near the points that do not answer.
  std::vector<CellBounds> bounds(map.bricks.size());
  maker.forAll(map.bricks.size(), [&](std::size_t n, const Accessor& accessor, Part& part) {
    Brick brick;
    maker.make(map.bricks[n], accessor, part, brick);
    boundCells(brick, maker.cubic(), bounds[n]);
  });
  const LeastWay way(map.bricks, bounds);
  tbb::enumerable_thread_specific<double> least(1.0);
  maker.forAll(map.bricks.size(), [&](std::size_t n, const Accessor& accessor, Part& part) {
    if (!way.matters(n)) return;
    Brick brick;
    maker.make(map.bricks[n], accessor, part, brick);
    double& own = least.local();
    own = std::min(own, way.in(n, brick, maker.cubic()));
  });
  survey.bounds.least_way = 1.0;
  for (const double each : least) survey.bounds.least_way = std::min(survey.bounds.least_way, each);
  return survey;
}

}  // namespace palpate::vdb
