#pragma once
/// Puts leaves and tiles together into a tree, in parallel.

#include <openvdb/openvdb.h>

#include <memory>
#include <vector>

namespace palpate::vdb {

using BandLeaf = openvdb::FloatTree::LeafNodeType;

/// A cube of `size` voxels, a power of 2 of at least 8; its origin is a multiple of it.
struct BandBlock {
  openvdb::Coord origin;
  int size = 8;
};

/// Adds leaves and tiles to a tree without voxels. `origins` are those of `leaves` (null: no leaf);
/// the blocks `inside` get the value -background. None may overlap another.
void fillTree(openvdb::FloatTree& tree, const std::vector<openvdb::Coord>& origins,
              std::vector<std::unique_ptr<BandLeaf>> leaves, const std::vector<BandBlock>& inside);

}  // namespace palpate::vdb
