#include <openvdb/tree/LeafManager.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "palpate/vdb/certificate.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

/// Each step is invertible, so that no difference is lost on the way.
std::uint64_t mixed(std::uint64_t state, std::uint64_t with) noexcept {
  state = (state ^ with) * 0x9E3779B97F4A7C15U;
  return state ^ (state >> 29);
}

std::uint64_t mixed(std::uint64_t state, const openvdb::Coord& at) noexcept {
  for (int axis = 0; axis < 3; ++axis) state = mixed(state, static_cast<std::uint32_t>(at[axis]));
  return state;
}

std::uint64_t bitsOf(double value) noexcept { return std::bit_cast<std::uint64_t>(value); }

/// Hash of a leaf's active values, and of the sign of the other voxels.
std::uint64_t hashOf(const Leaf& leaf) noexcept {
  std::uint64_t state = mixed(0x243F6A8885A308D3U, leaf.origin());
  const float* const values = leaf.buffer().data();
  for (openvdb::Index word = 0; word < 8; ++word) {
    const auto active = leaf.getValueMask().getWord<openvdb::Index64>(word);
    state = mixed(state, active);
    for (openvdb::Index n = 0; n < 64; ++n) {
      const float value = values[64 * word + n];
      const bool is_on = (active >> n & 1U) != 0;
      // Of an inactive voxel only the sign affects samples.
      state = mixed(state, is_on ? std::bit_cast<std::uint32_t>(value)
                                 : static_cast<std::uint32_t>(value < 0.0F ? 1 : 2));
    }
  }
  return state;
}

/// Whether a leaf could as well be a tile: no active voxels, and one sign.
bool isPlain(const Leaf& leaf) noexcept {
  if (!leaf.isEmpty()) return false;
  const float* const values = leaf.buffer().data();
  for (openvdb::Index n = 1; n < Leaf::SIZE; ++n) {
    if ((values[n] < 0.0F) != (values[0] < 0.0F)) return false;
  }
  return true;
}

std::uint64_t hashOfTile(const openvdb::Coord& origin, openvdb::Index size, float value,
                         bool active) noexcept {
  std::uint64_t state = mixed(mixed(0x13198A2E03707344U, origin), size);
  state = mixed(state, active ? std::bit_cast<std::uint32_t>(value) : 0U);
  return mixed(state, static_cast<std::uint64_t>(value < 0.0F ? 1 : 2));
}

}  // namespace

// Hashes of leaves and tiles are summed, so that their order does not matter. Outside tiles count
// as empty space.
std::string contentHash(const LevelSet& grid) {
  const openvdb::FloatGrid& floats = *grid.impl().grid;
  const Tree& tree = floats.tree();
  std::atomic<std::uint64_t> sum = 0;
  openvdb::tree::LeafManager<const Tree> leaves(tree);
  leaves.foreach ([&](const Leaf& leaf, std::size_t) {
    const bool is_plain = isPlain(leaf);
    if (is_plain && leaf.getValue(0) >= 0.0F) return;
    sum += is_plain ? hashOfTile(leaf.origin(), Leaf::DIM, leaf.getValue(0), false) : hashOf(leaf);
  });
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  std::uint64_t tiles = 0;
  for (; tile; ++tile) {
    if (!tile.isValueOn() && !(*tile < 0.0F)) continue;
    const openvdb::CoordBBox box = tile.getBoundingBox();
    tiles +=
        hashOfTile(box.min(), static_cast<openvdb::Index>(box.dim().x()), *tile, tile.isValueOn());
  }
  std::uint64_t state = mixed(mixed(0xA4093822299F31D0U, sum.load()), tiles);
  const LevelSetInfo& info = grid.info();
  state = mixed(state, bitsOf(static_cast<double>(tree.background())));
  state = mixed(state, bitsOf(info.voxel_size));
  state = mixed(state, bitsOf(info.meters_per_unit));
  for (int axis = 0; axis < 3; ++axis) state = mixed(state, bitsOf(grid.impl().origin[axis]));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(mixed(state, std::uint64_t{1})));
  return text;
}

}  // namespace palpate::vdb
