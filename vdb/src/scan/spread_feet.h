#pragma once
/// Passes closest points on from voxel to voxel, through the band and back.

#include <algorithm>
#include <bit>
#include <vector>

#include "scan/distance_leaves.h"
#include "scan/for_blocks.h"

namespace palpate::vdb {

/// The result of a voxel's search [voxels].
struct FoundFoot {
  std::size_t place = 0;
  Vec3 foot{0.0, 0.0, 0.0};
  double distance = 0.0;
  bool inside = false;
};

/// A Search is FoundFoot(std::size_t leaf, std::size_t place, const Vec3& start, const
/// openvdb::Coord& step). It finds the closest point of a voxel, starting from `start` [voxels from
/// the voxel], the closest point of the neighbor at `step`. All voxels of a round search before any
/// takes its result, so that the order of threads does not matter.
class FootSpread {
 public:
  /// `reach` [voxels]: voxels farther off than this pass nothing on to their neighbors.
  FootSpread(DistanceLeaves& leaves, double reach)
      : leaves_(leaves), reach_(reach), changed_(leaves.all().size(), 1) {}

  void take(DistanceLeaf& leaf, const FoundFoot& found) const noexcept {
    leaf.distance[found.place] = static_cast<float>(found.distance);
    if (found.inside) {
      setBit(leaf.inside, found.place);
    } else {
      clearBit(leaf.inside, found.place);
    }
    if (found.distance < reach_) {
      leaf.feet.set(found.place, found.foot);
      setBit(leaf.known, found.place);
    } else {
      leaf.feet.set(found.place, Vec3(static_cast<double>(Feet::kNone)));
      clearBit(leaf.known, found.place);
    }
  }

  /// Adds one more layer of voxels. False: there was none to add.
  template <typename Search>
  bool spread(const Search& search) {
    return round([&](std::size_t b, std::vector<FoundFoot>& fresh) {
      const DistanceLeaf& leaf = leaves_.all()[b];
      const Layer next = layerBeside(leaf);
      if (next.rows == 0) return;
      NearestFeet nearest(Mat3(1.0));
      nearest.find(leaves_.feetAround(leaf), next.rows);
      for (std::size_t place = 0; place < DistanceLeaf::kVoxels; ++place) {
        if (!testBit(next.voxels, place)) continue;
        fresh.push_back(search(b, place, nearest.foot(place), stepTo(nearest.which(place))));
      }
    });
  }

  /// Lets each voxel take a neighbor's point that is nearer by more than `nearer` [voxels]; false
  /// if there was none. To be called after the last spread().
  template <typename Search>
  bool lookAround(const Search& search, double nearer) {
    if (is_spreading_) std::fill(changed_.begin(), changed_.end(), std::uint8_t{1});
    is_spreading_ = false;
    return round([&](std::size_t b, std::vector<FoundFoot>& better) {
      const DistanceLeaf& leaf = leaves_.all()[b];
      NearestFeet nearest(Mat3(1.0));
      nearest.find(leaves_.feetAround(leaf), ~std::uint64_t{0});
      for (std::size_t place = 0; place < DistanceLeaf::kVoxels; ++place) {
        if (leaf.distance[place] == DistanceLeaf::kNowhere) continue;
        const float enough = leaf.distance[place] - static_cast<float>(nearer);
        if (!(enough > 0.0F && nearest.square(place) < enough * enough)) continue;
        const FoundFoot found = search(b, place, nearest.foot(place), stepTo(nearest.which(place)));
        if (found.distance < static_cast<double>(leaf.distance[place])) better.push_back(found);
      }
    });
  }

 private:
  struct Layer {
    VoxelBits voxels;
    std::uint64_t rows = 0;
  };

  /// Voxels that have no result yet, next to known ones.
  [[nodiscard]] Layer layerBeside(const DistanceLeaf& leaf) const noexcept {
    Layer next{leaves_.besideKnown(leaf)};
    for (std::size_t x = 0; x < 8; ++x) {
      next.voxels[x] &= ~leaf.known[x];
      for (std::uint64_t rest = next.voxels[x]; rest != 0; rest &= rest - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(rest));
        if (leaf.distance[64 * x + n] != DistanceLeaf::kNowhere) {
          next.voxels[x] &= ~(std::uint64_t{1} << n);  // has a result, but beyond the reach
        } else {
          next.rows |= std::uint64_t{1} << (8 * x + (n >> 3));
        }
      }
    }
    return next;
  }

  [[nodiscard]] static openvdb::Coord stepTo(int which) noexcept {
    return {which / 9 - 1, which / 3 % 3 - 1, which % 3 - 1};
  }

  /// Runs a round over all leaves, except those that did not change, and whose neighbors did not
  /// change. Returns whether something was found.
  template <typename Body>
  bool round(const Body& body) {
    std::vector<std::vector<FoundFoot>> found(leaves_.all().size());
    forBlocks(found.size(), [&](std::size_t b) {
      const auto& near = leaves_.all()[b].near;
      const bool is_beside = std::any_of(near.begin(), near.end(), [&](std::int32_t n) {
        return n >= 0 && changed_[static_cast<std::size_t>(n)] != 0;
      });
      if (is_beside) body(b, found[b]);
    });
    forBlocks(found.size(), [&](std::size_t b) {
      for (const FoundFoot& each : found[b]) take(leaves_.all()[b], each);
      changed_[b] = found[b].empty() ? 0 : 1;
    });
    return std::any_of(found.begin(), found.end(), [](const auto& each) { return !each.empty(); });
  }

  DistanceLeaves& leaves_;
  double reach_;
  bool is_spreading_ = true;
  std::vector<std::uint8_t> changed_;  ///< for each leaf: some voxel got a result in the last round
};

}  // namespace palpate::vdb
