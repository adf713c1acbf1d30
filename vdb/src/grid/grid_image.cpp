#include "palpate/vdb/grid_image.h"

#include <openvdb/tools/Dense.h>

#include "palpate/core/error.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {

Image gridImage(const LevelSet& grid) {
  const LevelSetInfo& info = grid.info();
  const openvdb::CoordBBox box = grid.impl().grid->evalActiveVoxelBoundingBox();
  if (box.empty()) {
    throw inputError("grid.no_surface", "the grid '" + info.name + "' has no active voxel");
  }
  const openvdb::Coord size = box.dim();
  constexpr double kMost = 1e9;
  const double count = static_cast<double>(size.x()) * size.y() * size.z();
  if (count > kMost) {
    throw Error(ErrorKind::kOperation,
                {"image.too_large",
                 "the box of the grid '" + info.name + "' has " + std::to_string(size.x()) + " x " +
                     std::to_string(size.y()) + " x " + std::to_string(size.z()) + " voxels",
                 "an image holds up to 10^9; bake with larger voxels"});
  }
  Image image;
  image.source = info.name;
  image.size = {size.x(), size.y(), size.z()};
  image.values.resize(static_cast<std::size_t>(count));
  image.axes = Mat3(info.voxel_size);
  const openvdb::Coord& first = box.min();
  image.origin = grid.impl().origin + info.voxel_size * Vec3(first.x(), first.y(), first.z());
  // x runs fastest, as in an image.
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, image.values.data());
  openvdb::tools::copyToDense(*grid.impl().grid, dense);
  return image;
}

}  // namespace palpate::vdb
