#include "bake/band_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <map>
#include <utility>

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Upper = Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;

Coord lowerOrigin(const Coord& at) {
  constexpr int kMask = ~static_cast<int>(Lower::DIM - 1);
  return {at.x() & kMask, at.y() & kMask, at.z() & kMask};
}

/// The contents of one lower node: indices into the lists of leaves and of blocks.
struct Group {
  std::vector<std::size_t> leaves, blocks;
};

std::unique_ptr<Lower> makeLower(const Coord& origin, const Group& group, float background,
                                 std::vector<std::unique_ptr<BandLeaf>>& leaves,
                                 const std::vector<BandBlock>& blocks) {
  auto node = std::make_unique<Lower>(origin, background, false);
  for (const std::size_t n : group.leaves) node->addLeaf(leaves[n].release());
  for (const std::size_t n : group.blocks) {
    const auto& [first, size] = blocks[n];
    for (int x = 0; x < size; x += 8) {
      for (int y = 0; y < size; y += 8) {
        for (int z = 0; z < size; z += 8) {
          node->addTile(Lower::coordToOffset(first.offsetBy(x, y, z)), -background, false);
        }
      }
    }
  }
  return node;
}

/// Groups in a fixed order. Successive voxels are mostly in the same group, so that the last one
/// found is tried first.
class Groups {
 public:
  [[nodiscard]] Group& at(const Coord& voxel) {
    const Coord origin = lowerOrigin(voxel);
    if (last_ == groups_.end() || last_->first != origin) {
      last_ = groups_.try_emplace(origin).first;
    }
    return last_->second;
  }
  [[nodiscard]] std::vector<std::pair<Coord, const Group*>> all() const {
    std::vector<std::pair<Coord, const Group*>> list;
    for (const auto& [origin, group] : groups_) list.emplace_back(origin, &group);
    return list;
  }

 private:
  std::map<Coord, Group> groups_;
  std::map<Coord, Group>::iterator last_ = groups_.end();
};

}  // namespace

void fillTree(Tree& tree, const std::vector<Coord>& origins,
              std::vector<std::unique_ptr<BandLeaf>> leaves, const std::vector<BandBlock>& inside) {
  const float background = tree.background();
  Groups groups;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    if (leaves[n] != nullptr) groups.at(origins[n]).leaves.push_back(n);
  }
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const auto& [origin, size] = inside[n];
    if (size < static_cast<int>(Lower::DIM)) {
      groups.at(origin).blocks.push_back(n);
    } else {
      tree.sparseFill(openvdb::CoordBBox::createCube(origin, size), -background, false);
    }
  }
  const auto list = groups.all();
  std::vector<std::unique_ptr<Lower>> nodes(list.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, list.size()), [&](const auto& range) {
    for (std::size_t n = range.begin(); n != range.end(); ++n) {
      nodes[n] = makeLower(list[n].first, *list[n].second, background, leaves, inside);
    }
  });
  for (std::size_t n = 0; n < list.size(); ++n) {
    auto* upper = tree.root().probeNode<Upper>(list[n].first);
    if (upper == nullptr) {
      upper = new Upper(list[n].first, background, false);
      tree.root().addChild(upper);
    }
    upper->addChild(nodes[n].release());
  }
}

}  // namespace palpate::vdb
