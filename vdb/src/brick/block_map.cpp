#include "brick/block_map.h"

#include <openvdb/tree/ValueAccessor.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "brick/brick_view.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

constexpr std::uint32_t kEntriesOfGroup = 512;
/// A table of one level may have this many entries for each brick, 4 bytes each beside its 5888.
constexpr std::uint64_t kEntriesPerBrick = 64;
constexpr std::uint64_t kEntriesAnyway = 1 << 16;
/// Most entries of the upper of two levels: 256 MB, for a box of 26000^3 voxels. A larger box can
/// only be a mistake.
constexpr double kMostGroups = 1 << 26;

Coord blockOf(const Coord& voxel) {
  return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};  // rounds down
}

/// Along one axis, the voxels of a block (bit n: voxel n) that are in stencils of the block before
/// it, of the block itself, and of the block behind it.
constexpr unsigned kReached[3] = {0x03, 0xFF, 0x80};

/// Adds the neighbors of a leaf that are not leaves, but have active voxels of this leaf in their
/// stencils.
void addReached(const Leaf& leaf, const Accessor& accessor, std::vector<Coord>& blocks) {
  const auto& mask = leaf.getValueMask();
  bool reached[3][3][3] = {};
  for (unsigned x = 0; x < 8; ++x) {
    const auto word = mask.getWord<openvdb::Index64>(x);  // a byte for each y
    for (unsigned y = 0; y < 8; ++y) {
      const auto row = static_cast<unsigned>(word >> (8 * y) & 0xFF);
      if (row == 0) continue;
      for (int i = 0; i < 3; ++i) {
        if ((kReached[i] >> x & 1U) == 0) continue;
        for (int j = 0; j < 3; ++j) {
          if ((kReached[j] >> y & 1U) == 0) continue;
          for (int k = 0; k < 3; ++k) reached[i][j][k] |= (kReached[k] & row) != 0;
        }
      }
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        const Coord at = leaf.origin().offsetBy(8 * (i - 1), 8 * (j - 1), 8 * (k - 1));
        if (reached[i][j][k] && accessor.probeConstLeaf(at) == nullptr) {
          blocks.push_back(blockOf(at));
        }
      }
    }
  }
}

class TableMaker {
 public:
  TableMaker(const Tree& tree, const BlockMap& map) : tree_(tree), map_(map) {}

  [[nodiscard]] BlockTable oneLevel() const {
    BlockTable table = sized(map_.box, 0);
    fill(map_.box, 3, table.blocks.data(), table.stride_x, table.stride_y);
    for (std::size_t n = 0; n < map_.bricks.size(); ++n) {
      const Coord at = map_.bricks[n] - map_.box.min();
      table.blocks[index(at, table)] = entryOf(n);
    }
    return table;
  }

  [[nodiscard]] BlockTable twoLevels() const {
    const CoordBBox groups(blockOf(map_.box.min()), blockOf(map_.box.max()));
    BlockTable table = sized(groups, 1);
    table.box = CoordBBox(groups.min() << 3, (groups.max() << 3).offsetBy(7));
    for (std::size_t n = 0; n < map_.bricks.size(); ++n) {
      const Coord block = map_.bricks[n];
      std::uint32_t& group = table.coarse[index(blockOf(block) - groups.min(), table)];
      if (group >= BrickView::kInside) group = addGroup(blockOf(block), table);
      table.blocks[group * std::size_t{kEntriesOfGroup} + within(block)] = entryOf(n);
    }
    return table;
  }

 private:
  static std::uint32_t entryOf(std::size_t brick) {
    return static_cast<std::uint32_t>(brick * (sizeof(Brick) / BrickView::kUnit));
  }
  static std::size_t index(const Coord& at, const BlockTable& table) {
    return static_cast<std::size_t>(at.x()) * table.stride_x +
           static_cast<std::size_t>(at.y()) * table.stride_y + static_cast<std::size_t>(at.z());
  }
  static std::size_t within(const Coord& block) {
    return static_cast<std::size_t>((block.x() & 7) << 6 | (block.y() & 7) << 3 | (block.z() & 7));
  }

  /// A table whose upper level covers `box`. Its entries are blocks, or groups, each with its sign.
  [[nodiscard]] BlockTable sized(const CoordBBox& box, int levels_below) const {
    BlockTable table;
    table.box = box;
    const Coord size = box.dim();
    table.stride_y = static_cast<std::uint32_t>(size.z());
    table.stride_x = table.stride_y * static_cast<std::uint32_t>(size.y());
    const auto count = static_cast<std::size_t>(box.volume());
    if (levels_below == 0) {
      table.blocks.resize(count);
      return table;
    }
    table.coarse.resize(count);
    fill(box, 6, table.coarse.data(), table.stride_x, table.stride_y);
    return table;
  }

  std::uint32_t addGroup(const Coord& group, BlockTable& table) const {
    const auto number = static_cast<std::uint32_t>(table.blocks.size() / kEntriesOfGroup);
    table.blocks.resize(table.blocks.size() + kEntriesOfGroup);
    fill(CoordBBox(group << 3, (group << 3).offsetBy(7)), 3,
         table.blocks.data() + table.blocks.size() - kEntriesOfGroup, 64, 8);
    return number;
  }

  /// Writes the signs of the cubes of `box`, each 2^`shift` voxels long.
  void fill(const CoordBBox& box, unsigned shift, std::uint32_t* entries, std::uint32_t stride_x,
            std::uint32_t stride_y) const {
    const Coord size = box.dim();
    tbb::parallel_for(tbb::blocked_range<int>(0, size.x()), [&](const auto& range) {
      const Accessor accessor(tree_);
      for (int x = range.begin(); x != range.end(); ++x) {
        for (int y = 0; y < size.y(); ++y) {
          std::uint32_t* const row = entries + static_cast<std::size_t>(x) * stride_x +
                                     static_cast<std::size_t>(y) * stride_y;
          for (int z = 0; z < size.z(); ++z) {
            const Coord voxel = (box.min() + Coord(x, y, z)) << shift;
            row[z] = accessor.getValue(voxel) < 0.0F ? BrickView::kInside : BrickView::kOutside;
          }
        }
      }
    });
  }

  const Tree& tree_;
  const BlockMap& map_;
};

}  // namespace

BlockMap mapBlocks(const Tree& tree) {
  BlockMap map;
  std::vector<const Leaf*> leaves;
  tree.getNodes(leaves);
  map.bricks.resize(leaves.size());
  tbb::enumerable_thread_specific<std::vector<Coord>> more;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()), [&](const auto& range) {
    const Accessor accessor(tree);
    std::vector<Coord>& reached = more.local();
    for (std::size_t n = range.begin(); n != range.end(); ++n) {
      map.bricks[n] = blockOf(leaves[n]->origin());
      addReached(*leaves[n], accessor, reached);
    }
  });
  for (const std::vector<Coord>& reached : more) {
    map.bricks.insert(map.bricks.end(), reached.begin(), reached.end());
  }
  // Sorted, so that their order does not depend on threads.
  tbb::parallel_sort(map.bricks.begin(), map.bricks.end());
  map.bricks.erase(std::unique(map.bricks.begin(), map.bricks.end()), map.bricks.end());
  for (const Coord& block : map.bricks) map.box.expand(block);
  auto tiles = tree.cbeginValueAll();
  tiles.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tiles; ++tiles) {
    if (!(*tiles < 0.0F)) continue;
    const CoordBBox tile = tiles.getBoundingBox();
    map.inside_tiles.expand(tile);
    map.box.expand(CoordBBox(blockOf(tile.min()), blockOf(tile.max())));
  }
  if (map.box.empty()) map.box = CoordBBox(Coord(0), Coord(0));
  return map;
}

BlockMap cutTo(const CoordBBox& voxels, const BlockMap& map) {
  BlockMap out;
  const CoordBBox blocks(blockOf(voxels.min()), blockOf(voxels.max()));
  std::copy_if(map.bricks.begin(), map.bricks.end(), std::back_inserter(out.bricks),
               [&](const Coord& block) { return blocks.isInside(block); });
  out.inside_tiles = map.inside_tiles;
  out.inside_tiles.intersect(voxels);
  out.box = map.box;
  out.box.intersect(blocks);
  if (out.box.empty()) out.box = CoordBBox(blocks.min(), blocks.min());
  return out;
}

BlockTable makeTable(const Tree& tree, const BlockMap& map) {
  const Coord size = map.box.dim();
  const double entries = static_cast<double>(size.x()) * size.y() * size.z();
  const double allowed =
      static_cast<double>(std::max(kEntriesPerBrick * map.bricks.size(), kEntriesAnyway));
  const TableMaker maker(tree, map);
  if (entries <= allowed) return maker.oneLevel();
  if (entries / kEntriesOfGroup > kMostGroups) {
    throw inputError("bricks.extent",
                     "the grid's voxels lie up to " + std::to_string(8LL * size[size.maxIndex()]) +
                         " voxels apart, too far for a table of bricks",
                     "remove what lies far off, or use the sampler `accessor`");
  }
  return maker.twoLevels();
}

}  // namespace palpate::vdb
