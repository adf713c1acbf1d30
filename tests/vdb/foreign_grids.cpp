#include "vdb/foreign_grids.h"

#include <openvdb/io/File.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/field_contract.h"

namespace palpate::vdb::test {
namespace {

using Grid = openvdb::FloatGrid;
using openvdb::Coord;
using palpate::test::Random;

constexpr double kMm = 1e-3;

int below(Random& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform(0.0, count)));
}

Grid::Ptr copyOfBake(const FieldPtr& field, double voxel, double half_width) {
  BakeOptions options;
  options.voxel_size = voxel;
  options.half_width = half_width;
  return bake(*field, options).impl().grid->deepCopy();
}

Grid::Ptr sphereOf(const Vec3& center, double radius, double voxel, double half_width) {
  openvdb::initialize();
  const openvdb::Vec3f at(static_cast<float>(center.x / kMm), static_cast<float>(center.y / kMm),
                          static_cast<float>(center.z / kMm));
  return openvdb::tools::createLevelSetSphere<Grid>(static_cast<float>(radius / kMm), at,
                                                    static_cast<float>(voxel / kMm),
                                                    static_cast<float>(half_width));
}

void make(Random& random, ForeignGrid& out) {
  const double voxel = random.uniform(0.5, 1.5) * kMm;
  const double half_width = below(random, 2) == 0 ? 3.0 : random.uniform(3.0, 8.0);
  const double radius = random.uniform(9.0, 14.0) * voxel;
  const Vec3 center = random.uniform(0.0, 5.0) * kMm * random.direction();
  switch (below(random, 5)) {
    case 0:
      out.how = "ball, baked here";
      out.truth = sphere(center, radius);
      out.grid = copyOfBake(out.truth, voxel, half_width);
      return;
    case 1:
      out.how = "ring, baked here";
      out.truth = torus(center, random.direction(), radius, 0.55 * radius);
      out.grid = copyOfBake(out.truth, voxel, half_width);
      return;
    case 2:
      out.how = "box, baked here";
      out.truth = box(center, radius * Vec3(1.6, 2.0, 1.8));
      out.grid = copyOfBake(out.truth, voxel, half_width);
      return;
    case 3: {
      out.how = "two balls by csgUnion";
      const Vec3 other = center + 0.8 * radius * random.direction();
      out.truth = unite({sphere(center, radius), sphere(other, 0.8 * radius)});
      out.grid = sphereOf(center, radius, voxel, half_width);
      const Grid::Ptr second = sphereOf(other, 0.8 * radius, voxel, half_width);
      openvdb::tools::csgUnion(*out.grid, *second);
      return;
    }
    default:
      out.how = "ball by createLevelSetSphere";
      out.truth = sphere(center, radius);
      out.grid = sphereOf(center, radius, voxel, half_width);
  }
}

std::vector<Coord> activeOf(const Grid& grid) {
  std::vector<Coord> all;
  for (auto value = grid.cbeginValueOn(); value; ++value) all.push_back(value.getCoord());
  return all;
}

/// Calls change(voxel) for all voxels within `reach` voxels of the place.
template <typename Change>
void around(const Coord& place, int reach, const Change& change) {
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        if (x * x + y * y + z * z <= reach * reach) change(place.offsetBy(x, y, z));
      }
    }
  }
}

void damage(Random& random, ForeignGrid& out) {
  Grid& grid = *out.grid;
  const std::vector<Coord> active = activeOf(grid);
  const Coord place = active[static_cast<std::size_t>(
      random.uniform(0.0, static_cast<double>(active.size()) - 0.5))];
  const openvdb::Vec3d where = grid.indexToWorld(place);
  out.damage = Vec3(where.x(), where.y(), where.z()) * kMm;
  out.is_damaged = true;
  auto accessor = grid.getAccessor();
  const float wide = grid.background();
  const auto voxel = static_cast<float>(grid.voxelSize().x());
  switch (below(random, 12)) {
    case 0:
      out.how += ", torn to the outside";
      return around(place, 3, [&](const Coord& at) { accessor.setValueOff(at, wide); });
    case 1:
      out.how += ", torn to the inside";
      return around(place, 2, [&](const Coord& at) { accessor.setValueOff(at, -wide); });
    case 2: {
      const auto by = static_cast<float>(random.uniform(-3.0, 3.0)) * voxel;
      out.how += ", one voxel off by " + std::to_string(by / voxel);
      return accessor.setValueOn(place, accessor.getValue(place) + by);
    }
    case 3: {
      const double size = random.uniform(0.0, 1.0);
      out.how += ", noise of " + std::to_string(size);
      for (const Coord& at : active) {
        accessor.setValueOn(
            at, accessor.getValue(at) + static_cast<float>(random.uniform(-size, size)) * voxel);
      }
      return;
    }
    case 4: {
      const auto scale = static_cast<float>(random.uniform(0.3, 3.0));
      out.how += ", scaled by " + std::to_string(scale);
      for (const Coord& at : active) accessor.setValueOn(at, accessor.getValue(at) * scale);
      return;
    }
    case 5:
      out.how += ", its sign turned somewhere";
      return around(place, 2, [&](const Coord& at) {
        float value = 0.0F;
        if (accessor.probeValue(at, value)) accessor.setValueOn(at, -value);
      });
    case 6:
      out.how += ", its inside not marked";
      for (auto value = grid.beginValueOff(); value; ++value) value.setValue(wide);
      return;
    case 7: {
      const auto by = static_cast<float>(random.uniform(-2.0, 2.0)) * voxel;
      out.how += ", one half moved by " + std::to_string(by / voxel);
      for (const Coord& at : active) {
        if (at.x() > place.x()) accessor.setValueOn(at, accessor.getValue(at) + by);
      }
      return;
    }
    case 8:
      out.how += ", a block of zeros";
      return around(place, 3, [&](const Coord& at) {
        if (accessor.isValueOn(at)) accessor.setValueOn(at, 0.0F);
      });
    case 9:
      out.how += ", cut off";
      for (const Coord& at : active) {
        if (at.y() > place.y()) accessor.setValueOff(at, wide);
      }
      return;
    case 10:
      out.how += ", far values wrong";
      return around(place, 2, [&](const Coord& at) {
        float value = 0.0F;
        if (accessor.probeValue(at, value) && std::fabs(value) > 2.3F * voxel) {
          accessor.setValueOn(at, std::copysign(2.2F * voxel, value));
        }
      });
    default:
      out.how += ", a value of 1e30";
      return accessor.setValueOn(place, 1e30F);
  }
}

}  // namespace

ForeignGrid foreignGrid(std::uint64_t seed) {
  Random random(seed);
  ForeignGrid out;
  make(random, out);
  if (seed % 2 == 1) damage(random, out);
  out.grid->setName("shape");
  out.grid->setGridClass(openvdb::GRID_LEVEL_SET);
  return out;
}

void writeAsOthers(const std::string& path, const Grid::Ptr& grid) {
  grid->insertMeta("length_unit", openvdb::StringMetadata("mm"));
  openvdb::io::File file(path);
  openvdb::GridPtrVec grids;
  grids.push_back(grid);
  file.write(grids);
  file.close();
}

}  // namespace palpate::vdb::test
