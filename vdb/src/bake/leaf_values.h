#pragma once
/// The voxels of one leaf while their values are computed, a cube of 4^3 at a time.

#include <array>
#include <cstdint>
#include <memory>

#include "bake/band_tree.h"
#include "palpate/fields/field.h"

namespace palpate::vdb {

struct LeafValues {
  alignas(64) std::array<float, BandLeaf::SIZE> values;  ///< [units]
  std::array<std::uint64_t, 8> active{};                 ///< a word for each x, a bit for y * 8 + z
  bool any_active = false;
  bool any_inside = false;
  bool any_outside = false;
  bool is_broken = false;  ///< some value is not a number

  /// One value for a cube, outside the band. `local` is its first voxel in the leaf.
  void fill(const openvdb::Coord& local, float value) noexcept;

  /// Stores distances [m], z fastest. Those below `background` [units] are in the band; the others
  /// become the background, with their sign.
  void store(const openvdb::Coord& local, const ValueBatch& distances, double units_per_meter,
             float background) noexcept;

  [[nodiscard]] std::unique_ptr<BandLeaf> leafAt(const openvdb::Coord& origin,
                                                 float background) const;
};

}  // namespace palpate::vdb
