#include <openvdb/openvdb.h>

#include <fstream>
#include <sstream>

#include "fuzz/seeds.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/temp_file.h"

namespace palpate::fuzz {
namespace {

std::string contentOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

template <typename Grid>
typename Grid::Ptr gridOf(const std::string& name, const typename Grid::ValueType& value) {
  auto grid = Grid::create();
  grid->setName(name);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  grid->insertMeta("length_unit", openvdb::StringMetadata("mm"));
  for (int i = 0; i < 40; ++i) {
    grid->tree().setValueOn(openvdb::Coord(3 * i - 50, i % 7, -2 * i), value);
  }
  grid->fill(openvdb::CoordBBox(openvdb::Coord(128), openvdb::Coord(143)), value);
  return grid;
}

std::string fileOf(const openvdb::GridCPtrVec& grids, std::uint32_t compression) {
  const palpate::testing::TempFolder folder;
  openvdb::io::File file(folder.path("seed.vdb"));
  file.setCompression(compression);
  file.write(grids);
  file.close();
  return contentOf(folder.path("seed.vdb"));
}

}  // namespace

std::vector<std::string> vdbSeeds() {
  vdb::initializeOpenVdb();
  std::vector<std::string> seeds;
  {
    const palpate::testing::TempFolder folder;
    vdb::BakeOptions options;
    options.voxel_size = 1e-3;
    options.half_width = 3.0;
    const std::vector<vdb::LevelSet> grids = {vdb::bake(*sphere(Vec3(0.0), 6e-3), options)};
    vdb::writeVdb(folder.path("seed.vdb"), grids, false);
    seeds.push_back(contentOf(folder.path("seed.vdb")));
  }
  auto half = gridOf<openvdb::FloatGrid>("half", 0.25F);
  half->setSaveFloatAsHalf(true);
  const openvdb::GridCPtrVec all = {gridOf<openvdb::FloatGrid>("float", 0.5F),
                                    half,
                                    gridOf<openvdb::DoubleGrid>("double", 0.5),
                                    gridOf<openvdb::Int32Grid>("int", 7),
                                    gridOf<openvdb::Int64Grid>("long", 7),
                                    gridOf<openvdb::BoolGrid>("bool", true),
                                    gridOf<openvdb::Vec3SGrid>("vector", openvdb::Vec3s(1, 2, 3)),
                                    gridOf<openvdb::MaskGrid>("mask", true)};
  using namespace openvdb::io;
  constexpr std::uint32_t kWays[] = {COMPRESS_NONE, COMPRESS_ZIP,
                                     COMPRESS_ZIP | COMPRESS_ACTIVE_MASK,
                                     COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK};
  for (const std::uint32_t compression : kWays) {
    seeds.push_back(fileOf(all, compression));
  }
  // A frustum, and two names for one tree.
  auto frustum = gridOf<openvdb::FloatGrid>("frustum", 0.5F);
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 2.0));
  auto second = half->copy();
  second->setName("second");
  seeds.push_back(fileOf({half, second, frustum}, COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK));
  return seeds;
}

}  // namespace palpate::fuzz
