#include "palpate/vdb/grid_image.h"

#include <openvdb/tools/Dense.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <memory>

#include "grid/mark_inside.h"
#include "grid/vdb_file.h"
#include "palpate/core/error.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

/// An image with room for the voxels of `box`, not yet placed.
Image emptyImage(const openvdb::CoordBBox& box, const std::string& name) {
  const openvdb::Coord size = box.dim();
  constexpr double kMost = 1e9;
  const double count = static_cast<double>(size.x()) * size.y() * size.z();
  if (count > kMost) {
    throw Error(ErrorKind::kOperation,
                {"image.too_large",
                 "the box of the grid '" + name + "' has " + std::to_string(size.x()) + " x " +
                     std::to_string(size.y()) + " x " + std::to_string(size.z()) + " voxels",
                 "an image holds up to 10^9; bake with larger voxels"});
  }
  Image image;
  image.source = name;
  image.size = {size.x(), size.y(), size.z()};
  image.values.resize(static_cast<std::size_t>(count));
  return image;
}

/// Fills the image if the grid is of this type.
template <typename Grid>
bool fillFrom(const openvdb::GridBase& base, const openvdb::CoordBBox& box, Image& image) {
  const auto* const grid = dynamic_cast<const Grid*>(&base);
  if (grid == nullptr) return false;
  const auto row = static_cast<std::size_t>(image.size[0]);
  const auto rows = static_cast<std::size_t>(image.size[1]);
  tbb::parallel_for(
      tbb::blocked_range<int>(0, image.size[2]), [&](const tbb::blocked_range<int>& range) {
        const auto accessor = grid->getConstAccessor();
        for (int k = range.begin(); k != range.end(); ++k) {
          for (int j = 0; j < image.size[1]; ++j) {
            float* const out = image.values.data() + row * (static_cast<std::size_t>(j) +
                                                            rows * static_cast<std::size_t>(k));
            for (int i = 0; i < image.size[0]; ++i) {
              out[i] = static_cast<float>(accessor.getValue(box.min().offsetBy(i, j, k)));
            }
          }
        }
      });
  return true;
}

template <typename... Grids>
bool fillFromAny(const openvdb::GridBase& base, const openvdb::CoordBBox& box, Image& image) {
  return (fillFrom<Grids>(base, box, image) || ...);
}

Vec3 fromVdb(const openvdb::Vec3d& v) { return {v.x(), v.y(), v.z()}; }

/// [m] of the length unit of a grid. @throws Error (kInput, unit.unknown).
double metersOf(const openvdb::GridBase& grid, const std::string& unit_if_missing,
                const std::string& path) {
  const std::string unit = unitOf(grid, unit_if_missing, path);
  const auto meters = metersPer(unit);
  if (meters) return *meters;
  throw inputError("unit.unknown", "unknown length unit '" + unit + "'", "use m, cm, mm or um",
                   path);
}

Image imageOf(const openvdb::GridBase& grid, double meters, const std::string& path) {
  if (!grid.transform().isLinear()) {
    throw inputError("vdb.transform",
                     "grid '" + grid.getName() + "' has a transform that is not linear (a frustum)",
                     "resample it to cubic voxels first", path);
  }
  openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) {
    throw inputError("vdb.empty", "grid '" + grid.getName() + "' has no voxels", "", path);
  }
  box.expand(1);
  Image image = emptyImage(box, grid.getName());
  if (!fillFromAny<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                   openvdb::BoolGrid, openvdb::MaskGrid>(grid, box, image)) {
    throw inputError(
        "vdb.type",
        "grid '" + grid.getName() + "' is a " + typeOf(grid) + "; an image has one number a voxel",
        "", path);
  }
  image.source = path;
  const Vec3 origin = fromVdb(grid.indexToWorld(openvdb::Vec3d(0.0)));
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d step(0.0);
    step[axis] = 1.0;
    image.axes[axis] = meters * (fromVdb(grid.indexToWorld(step)) - origin);
  }
  image.origin = meters * fromVdb(grid.indexToWorld(box.min()));
  return image;
}

/// The grid as floats; null if its values are not numbers.
openvdb::FloatGrid::Ptr asFloats(const openvdb::GridBase::Ptr& grid) {
  if (const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid)) {
    return std::make_shared<openvdb::FloatGrid>(*doubles);
  }
  return openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
}

}  // namespace

Image gridImage(const LevelSet& grid) {
  const LevelSetInfo& info = grid.info();
  const openvdb::CoordBBox box = grid.impl().grid->evalActiveVoxelBoundingBox();
  if (box.empty()) {
    throw inputError("grid.no_surface", "the grid '" + info.name + "' has no active voxel");
  }
  Image image = emptyImage(box, info.name);
  image.axes = Mat3(info.voxel_size);
  const openvdb::Coord& first = box.min();
  image.origin = grid.impl().origin + info.voxel_size * Vec3(first.x(), first.y(), first.z());
  // x runs fastest, as in an image.
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, image.values.data());
  openvdb::tools::copyToDense(*grid.impl().grid, dense);
  return image;
}

Image readVdbImage(const std::string& path, const std::string& name,
                   const std::string& unit_if_missing) {
  VdbFile file(path);
  const openvdb::GridBase::Ptr grid = file.read(file.choose(name));
  return imageOf(*grid, metersOf(*grid, unit_if_missing, path), path);
}

DistanceImage readVdbDistances(const std::string& path, const std::string& name,
                               const std::string& unit_if_missing) {
  VdbFile file(path);
  const openvdb::GridBase::Ptr grid = file.read(file.choose(name));
  const double meters = metersOf(*grid, unit_if_missing, path);
  const openvdb::FloatGrid::Ptr floats = asFloats(grid);
  if (!floats) {
    throw inputError("vdb.type",
                     "grid '" + grid->getName() + "' is a " + typeOf(*grid) +
                         "; distances are floats or doubles",
                     "", path);
  }
  const std::uint64_t marked = markInside(*floats, meters, path);
  return {imageOf(*floats, meters, path), marked};
}

}  // namespace palpate::vdb
