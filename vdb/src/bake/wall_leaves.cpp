#include "bake/wall_leaves.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/band_source.h"
#include "bake/band_tree.h"
#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr std::size_t kVoxels = DistanceLeaf::kVoxels;

class LeafMaker {
 public:
  LeafMaker(const DistanceLeaves& leaves, const Field& field, const BakeDomain& domain,
            const BakePlan& plan)
      : leaves_(leaves),
        source_(field, domain.box, domain.is_cut, plan.band),
        domain_(domain),
        plan_(plan) {}

  /// The leaf at `origin`; null if no voxel is active.
  [[nodiscard]] std::unique_ptr<BandLeaf> at(const Coord& origin) const {
    const std::int32_t index = leaves_.indexAt(origin);
    const DistanceLeaf* const from =
        index < 0 ? nullptr : &leaves_.all()[static_cast<std::size_t>(index)];
    const bool by_wall = domain_.is_cut && wallReaches(origin);
    if (from == nullptr && !by_wall) return nullptr;
    // Some distances beyond the faces are known too, to the part of the surface that the faces cut
    // off: leave them out.
    if (domain_.is_cut && !by_wall && isBeyond(origin)) return nullptr;
    auto leaf = std::make_unique<BandLeaf>(origin, plan_.background, false);
    for (std::size_t n = 0; n < kVoxels; ++n) {
      if (from != nullptr && from->distance[n] != DistanceLeaf::kNowhere) {
        const double size = static_cast<double>(from->distance[n]) * plan_.voxel;
        const double value = testBit(from->inside, n) ? -size : size;
        set(*leaf, n, by_wall ? std::max(value, wallAt(origin, n)) : value);
      } else if (by_wall) {
        // Outside the field's own band only its side counts.
        const double wall = wallAt(origin, n);
        const double out = 2.0 * plan_.band;
        const bool inside =
            wall < plan_.band && source_.parts().value(source_.whole(), position(origin, n)) < 0.0;
        set(*leaf, n, inside ? wall : out);
      }
    }
    return leaf->isEmpty() ? nullptr : std::move(leaf);
  }

  /// Origins of the leaves in or near which a face of the box lies; sorted.
  [[nodiscard]] std::vector<Coord> wallOrigins() const {
    std::vector<Coord> origins;
    const openvdb::CoordBBox range = voxelRange(domain_.box, plan_, "");
    const double reach = plan_.band / plan_.voxel + 8.0;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double face : {domain_.box.lo[axis], domain_.box.hi[axis]}) {
        openvdb::CoordBBox slab = range;
        const double at = face / plan_.voxel;
        slab.min()[axis] = std::max(slab.min()[axis], static_cast<int>(std::floor(at - reach)));
        slab.max()[axis] = std::min(slab.max()[axis], static_cast<int>(std::ceil(at + reach)));
        for (int x = slab.min().x() & ~7; x <= slab.max().x(); x += 8) {
          for (int y = slab.min().y() & ~7; y <= slab.max().y(); y += 8) {
            for (int z = slab.min().z() & ~7; z <= slab.max().z(); z += 8) {
              if (wallReaches({x, y, z})) origins.emplace_back(x, y, z);
            }
          }
        }
      }
    }
    return origins;
  }

 private:
  [[nodiscard]] Vec3 position(const Coord& origin, std::size_t n) const noexcept {
    const auto place = static_cast<int>(n);
    return Vec3(origin.x() + (place >> 6), origin.y() + (place >> 3 & 7),
                origin.z() + (place & 7)) *
           plan_.voxel;
  }
  [[nodiscard]] double wallAt(const Coord& origin, std::size_t n) const noexcept {
    return source_.boxDistance(position(origin, n));
  }
  [[nodiscard]] Vec3 centerOf(const Coord& origin) const noexcept {
    return (Vec3(origin.x(), origin.y(), origin.z()) + Vec3(3.5)) * plan_.voxel;
  }
  /// Whether the wall changes voxels of the leaf, and leaves some in the band.
  [[nodiscard]] bool wallReaches(const Coord& origin) const noexcept {
    const double radius = 3.5 * std::sqrt(3.0) * plan_.voxel;
    return std::fabs(source_.boxDistance(centerOf(origin))) < plan_.band + radius;
  }
  /// Whether the leaf's middle is outside the box.
  [[nodiscard]] bool isBeyond(const Coord& origin) const noexcept {
    return source_.boxDistance(centerOf(origin)) > 0.0;
  }
  void set(BandLeaf& leaf, std::size_t n, double meters) const {
    const auto value = static_cast<float>(meters / plan_.meters_per_unit);
    const auto place = static_cast<openvdb::Index>(n);
    if (std::fabs(value) < plan_.background) {
      leaf.setValueOn(place, value);
    } else {
      leaf.setValueOff(place, std::copysign(plan_.background, value));
    }
  }

  const DistanceLeaves& leaves_;
  BandSource source_;
  const BakeDomain& domain_;
  const BakePlan& plan_;
};

}  // namespace

void addLeaves(const DistanceLeaves& leaves, const Field& field, const BakeDomain& domain,
               const BakePlan& plan, openvdb::FloatGrid& grid) {
  const LeafMaker maker(leaves, field, domain, plan);
  std::vector<Coord> origins;
  for (const DistanceLeaf& leaf : leaves.all()) origins.push_back(leaf.origin);
  if (domain.is_cut) {
    const std::vector<Coord> walls = maker.wallOrigins();
    origins.insert(origins.end(), walls.begin(), walls.end());
    std::sort(origins.begin(), origins.end());
    origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  }
  std::vector<std::unique_ptr<BandLeaf>> made(origins.size());
  forBlocks(origins.size(), [&](std::size_t n) { made[n] = maker.at(origins[n]); });
  for (auto& leaf : made) {
    if (leaf) grid.tree().addLeaf(leaf.release());
  }
}

}  // namespace palpate::vdb
