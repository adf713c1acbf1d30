#pragma once
/// Reads values of a level set, in voxels. One object for each thread.

#include <openvdb/openvdb.h>

#include <glm/common.hpp>

#include "bake/bake_plan.h"
#include "palpate/core/math.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {

class GridValues {
 public:
  using Leaf = openvdb::FloatTree::LeafNodeType;

  GridValues(const LevelSet& grid, const BakePlan& plan)
      : values_(grid.impl().grid->tree()), voxels_per_unit_(plan.meters_per_unit / plan.voxel) {}

  [[nodiscard]] const Leaf* leafAt(const openvdb::Coord& at) const {
    return values_.probeConstLeaf(at);
  }
  [[nodiscard]] double inVoxels(float value) const noexcept { return value * voxels_per_unit_; }
  [[nodiscard]] double at(const openvdb::Coord& voxel) const {
    return inVoxels(values_.getValue(voxel));
  }
  /// Trilinear interpolation at a place given in voxels.
  [[nodiscard]] double at(const Vec3& p) const {
    const Vec3 low = glm::floor(p);
    const openvdb::Coord first(static_cast<int>(low.x), static_cast<int>(low.y),
                               static_cast<int>(low.z));
    const auto along_z = [&](int x, int y) {
      const openvdb::Coord begin = first.offsetBy(x, y, 0);
      return glm::mix(at(begin), at(begin.offsetBy(0, 0, 1)), p.z - low.z);
    };
    return glm::mix(glm::mix(along_z(0, 0), along_z(0, 1), p.y - low.y),
                    glm::mix(along_z(1, 0), along_z(1, 1), p.y - low.y), p.x - low.x);
  }

 private:
  openvdb::FloatGrid::ConstAccessor values_;
  double voxels_per_unit_;
};

}  // namespace palpate::vdb
