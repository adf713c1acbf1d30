#pragma once
/// One pass over all voxels of a grid of distances: the findings that checkVdb() reports and that
/// repairs rely on.

#include <openvdb/openvdb.h>

#include <cstdint>

namespace palpate::vdb {

/// Voxels with one defect, in any order, and the first of them.
struct FoundVoxels {
  std::uint64_t voxels = 0;
  openvdb::Coord first;

  void add(const openvdb::Coord& at) {
    if (voxels++ == 0) first = at;
  }
  void add(const FoundVoxels& later) {
    if (voxels == 0) first = later.first;
    voxels += later.voxels;
  }
};

/// The findings in one leaf, or in the whole grid; GridCheck explains each of them.
struct GridTally {
  FoundVoxels not_finite;
  FoundVoxels sign_breaks;
  FoundVoxels band_holes;
  std::uint64_t inside_voxels = 0;
  std::uint64_t gradients = 0;
  double sum = 0.0;
  double squares = 0.0;  ///< of the differences of |gradient| to 1
  double worst = 1.0;
  openvdb::Coord worst_at;
  double inside = 0.0;         ///< [voxels]
  double marked_inside = 0.0;  ///< [voxels] the part of `inside` that is not active

  void add(const GridTally& other);
};

/// Works in parallel, leaf by leaf; the first of each kind is the first in the tree's order.
[[nodiscard]] GridTally tallyOf(const openvdb::FloatGrid& grid);

}  // namespace palpate::vdb
