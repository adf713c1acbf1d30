#pragma once
/// Which blocks of a grid become bricks, and the table that finds them.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

namespace palpate::vdb {

/// Blocks of 8^3 voxels are named by their coordinates, which are those of their first voxel
/// over 8.
struct BlockMap {
  std::vector<openvdb::Coord> bricks;  ///< blocks that get a brick, in the order of memory
  openvdb::CoordBBox inside_tiles;     ///< [voxels] of all tiles inside
  openvdb::CoordBBox box;              ///< of all blocks that have a brick or lie inside
};

/// A block gets a brick if it is a leaf, or if a voxel of the band is in the stencil of one of its
/// cells: everywhere else the sampled function is flat, so that it has no jump where bricks end.
[[nodiscard]] BlockMap mapBlocks(const openvdb::FloatTree& tree);

/// Only what lies within `voxels`; what the tables say beyond means nothing.
[[nodiscard]] BlockMap cutTo(const openvdb::CoordBBox& voxels, const BlockMap& map);

/// Of all blocks of a box: where the brick is, in units of BrickView::kUnit, or BrickView's words.
struct BlockTable {
  std::vector<std::uint32_t> blocks;
  /// Empty if one level is enough. Otherwise of the groups of 8^3 blocks: which 512 entries of
  /// `blocks`, or BrickView's words, if there is no brick and no border in the group.
  std::vector<std::uint32_t> coarse;
  std::uint32_t stride_x = 0, stride_y = 0;  ///< of the upper level
  openvdb::CoordBBox box;                    ///< [blocks] what the table covers
};

/// One level while it is small beside the bricks, two levels otherwise. @throws Error (kInput) if
/// the blocks lie too far apart for these.
[[nodiscard]] BlockTable makeTable(const openvdb::FloatTree& tree, const BlockMap& map);

}  // namespace palpate::vdb
