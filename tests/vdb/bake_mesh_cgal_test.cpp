// Bands of meshes against CGAL's closest points.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "cgal/cgal_distance.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

/// [voxels] The largest error of some `count` active voxels, all over the band.
double worstError(const LevelSet& set, const CgalDistance& exact, std::uint64_t count,
                  bool with_signs) {
  const double voxel = set.info().voxel_size;
  const std::uint64_t every = std::max<std::uint64_t>(1, set.info().active_voxels / count);
  double worst = 0.0;
  std::uint64_t n = 0;
  for (auto at = set.impl().grid->cbeginValueOn(); at; ++at) {
    if (n++ % every != 0) continue;
    const openvdb::Coord c = at.getCoord();
    const Vec3 p = Vec3(c.x(), c.y(), c.z()) * voxel;
    const double value = static_cast<double>(*at) * 1e-3;
    worst = std::max(worst, std::abs(std::abs(value) - exact.to(p)) / voxel);
    if (with_signs) {
      EXPECT_EQ(value < 0.0, exact.isInside(p)) << p.x << ' ' << p.y << ' ' << p.z;
    }
  }
  return worst;
}

/// [m^3] Each voxel by its share: exact for planes, second order for curved faces.
double volumeOf(const LevelSet& set) {
  const openvdb::FloatGrid& grid = *set.impl().grid;
  const double voxel = set.info().voxel_size;
  double voxels = 0.0;
  for (auto at = grid.cbeginValueAll(); at; ++at) {
    const double share = std::clamp(0.5 - static_cast<double>(*at) * 1e-3 / voxel, 0.0, 1.0);
    voxels += share * static_cast<double>(at.getVoxelCount());
  }
  return voxels * std::pow(voxel, 3.0);
}

TEST(BakeMeshCgal, BallsAreExact) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  for (const int levels : slow ? std::vector<int>{5, 7, 8} : std::vector<int>{5}) {
    const Mesh mesh = ballMesh(Vec3(0.31e-3, -0.17e-3, 0.23e-3), 50e-3, levels);
    const CgalDistance exact(mesh);
    for (const double resolution :
         slow ? std::vector<double>{100.0, 200.0, 400.0} : std::vector<double>{12.0, 25.0, 50.0}) {
      const LevelSet set = bakeMesh(mesh, voxels(50e-3 / resolution, 3.0));
      const double worst = worstError(set, exact, slow ? 300'000 : 10'000, false);
      EXPECT_LE(worst, 1e-5) << mesh.triangles.size() << " triangles, R/h " << resolution;
      if (slow) {
        std::printf("%zu triangles, R/h %g: worst %.2g voxel of %llu voxels\n",
                    mesh.triangles.size(), resolution, worst,
                    static_cast<unsigned long long>(set.info().active_voxels));
      }
    }
  }
}

struct Known {
  const char* name;
  double unit, voxel;  ///< [m]
};

class BakeMeshCgalReal : public testing::TestWithParam<Known> {};

TEST_P(BakeMeshCgalReal, IsExactAndAsLargeAsItsMesh) {
  const std::string folder = PALPATE_SOURCE_DIR "/../shared/data/meshes/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared/data is not there";
  const Known& known = GetParam();
  const Mesh mesh = readMesh(folder + known.name, known.unit);
  const LevelSet set = bakeMesh(mesh, voxels(known.voxel, 3.0));
  EXPECT_LE(worstError(set, CgalDistance(mesh), 5000, true), 1e-5);
  EXPECT_NEAR(volumeOf(set) / cgalVolume(mesh), 1.0, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(
    All, BakeMeshCgalReal,
    testing::Values(Known{"brain_region.stl", 1e-3, 0.25e-3},
                    Known{"brain_region2.stl", 1e-3, 0.25e-3},
                    Known{"footbones.ply", 10e-3, 0.3e-3}, Known{"liver-smooth.obj", 1e-3, 0.04e-3},
                    Known{"malleus.obj", 1e-3, 0.04e-3}, Known{"tooth.obj", 1e-4, 0.3e-3}),
    [](const auto& known) {
      std::string name = known.param.name;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

}  // namespace
}  // namespace palpate::vdb
