#pragma once
/// Decides which blocks of a grid become bricks, and makes the table that finds them.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

namespace palpate::vdb {

/// Blocks of 8^3 voxels; a block's coordinates are those of its first voxel divided by 8.
struct BlockMap {
  std::vector<openvdb::Coord> bricks;  ///< blocks that get a brick, in the order of memory
  openvdb::CoordBBox inside_tiles;     ///< [voxels] around all tiles inside
  openvdb::CoordBBox box;              ///< around all blocks that have a brick or lie inside
};

/// A block gets a brick if it is a leaf, or if a voxel of the band is in the stencil of one of its
/// cells. Everywhere else the sampled function is constant, so that it has no jump where bricks
/// end.
[[nodiscard]] BlockMap mapBlocks(const openvdb::FloatTree& tree);

/// Keeps only the part within `voxels`; entries of the tables beyond it mean nothing.
[[nodiscard]] BlockMap cutTo(const openvdb::CoordBBox& voxels, const BlockMap& map);

/// For all blocks of a box: where the brick is, in units of BrickView::kUnit, or one of BrickView's
/// constants.
struct BlockTable {
  std::vector<std::uint32_t> blocks;
  /// Empty if one level is enough. Otherwise an entry for each group of 8^3 blocks: which 512
  /// entries of `blocks` it has, or one of BrickView's constants, if there is no brick and no
  /// change of sign in the group.
  std::vector<std::uint32_t> coarse;
  std::uint32_t stride_x = 0, stride_y = 0;  ///< of the upper level
  openvdb::CoordBBox box;                    ///< [blocks] what the table covers
};

/// One level while it is small compared with the bricks, two levels otherwise. @throws Error
/// (kInput) if the blocks are too far apart for two levels.
[[nodiscard]] BlockTable makeTable(const openvdb::FloatTree& tree, const BlockMap& map);

}  // namespace palpate::vdb
