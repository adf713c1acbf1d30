// Bands of meshes compared with CGAL's closest points.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "cgal/cgal_distance.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/scan_folder.h"
#include "vdb/debian_scans.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

/// [voxels] Errors of some voxels all over a band.
struct Off {
  std::uint64_t voxels = 0;
  double worst = 0.0;  ///< largest error of the distance
  /// Largest amount by which a voxel's value is less than the distance to any triangle
  double nearer = 0.0;
  std::uint64_t farther = 0;  ///< number of voxels farther by more than 1e-5
  std::uint64_t wrong_sides = 0;
};

Off offOf(const LevelSet& set, const CgalDistance& exact, std::uint64_t count, bool with_sides) {
  const double voxel = set.info().voxel_size;
  const std::uint64_t every = std::max<std::uint64_t>(1, set.info().active_voxels / count);
  Off off;
  std::uint64_t n = 0;
  for (auto at = set.impl().grid->cbeginValueOn(); at; ++at) {
    if (n++ % every != 0) continue;
    const openvdb::Coord c = at.getCoord();
    const Vec3 p = Vec3(c.x(), c.y(), c.z()) * voxel;
    const double value = static_cast<double>(*at) * 1e-3;
    const double error = (std::abs(value) - exact.to(p)) / voxel;
    ++off.voxels;
    off.worst = std::max(off.worst, std::abs(error));
    off.nearer = std::max(off.nearer, -error);
    if (error > 1e-5) ++off.farther;
    if (with_sides && (value < 0.0) != exact.isInside(p)) ++off.wrong_sides;
  }
  return off;
}

/// [m^3] Volume, each voxel by its share: exact for planes, second order for curved faces.
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
      const double worst = offOf(set, exact, slow ? 300'000 : 10'000, false).worst;
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
  double overlaps;     ///< largest share of the band that is near to walls inside the solid
};

/// A closed mesh, and its volume if its triangles give it; if several parts overlap, they do not.
void expectExact(const Mesh& mesh, const Known& known, double told_volume = 0.0) {
  const LevelSet set = bakeMesh(mesh, voxels(known.voxel, 3.0));
  const CgalDistance exact(mesh);
  const Off off = offOf(set, exact, 5000, true);
  EXPECT_LE(off.nearer, 1e-5);
  EXPECT_EQ(off.wrong_sides, 0U);
  // In some meshes parts overlap: walls inside the solid were removed, and voxels near them are
  // farther from the surface than from those walls.
  EXPECT_LE(static_cast<double>(off.farther), known.overlaps * static_cast<double>(off.voxels));
  if (known.overlaps == 0.0) {
    EXPECT_LE(off.worst, 1e-5);
  }
  const double volume = told_volume > 0.0 ? told_volume : exact.volume(known.voxel);
  ::testing::Test::RecordProperty("volume", std::to_string(volumeOf(set) / volume));
  EXPECT_NEAR(volumeOf(set) / volume, 1.0, 2e-3);
}

TEST(BakeMeshCgal, NucleiOfABrainAreExact) {
  for (const int label : {73, 77}) {
    SCOPED_TRACE(label);
    const Mesh mesh = nucleusMesh(label);
    expectExact(mesh, {"", 1e-3, 0.4e-3, 0.0}, checkMesh(mesh).volume);
  }
}

class BakeMeshCgalReal : public ::testing::TestWithParam<Known> {};

TEST_P(BakeMeshCgalReal, IsExactAndAsLargeAsItsMesh) {
  const std::string folder = palpate::testing::scanPath("meshes/");
  PALPATE_NEEDS_SCAN(folder);
  const Known& known = GetParam();
  expectExact(readMesh(folder + known.name, known.unit), known);
}

INSTANTIATE_TEST_SUITE_P(All, BakeMeshCgalReal,
                         ::testing::Values(Known{"brain_region.stl", 1e-3, 0.25e-3, 0.0},
                                           Known{"brain_region2.stl", 1e-3, 0.25e-3, 0.0},
                                           Known{"footbones.ply", 10e-3, 0.3e-3, 0.1},
                                           Known{"liver-smooth.obj", 1e-3, 0.04e-3, 0.05},
                                           Known{"malleus.obj", 1e-3, 0.04e-3, 0.05},
                                           Known{"tooth.obj", 1e-4, 0.3e-3, 0.5}),
                         [](const auto& known) {
                           std::string name = known.param.name;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) {
                                 return std::isalnum(static_cast<unsigned char>(c)) == 0;
                               },
                               '_');
                           return name;
                         });

}  // namespace
}  // namespace palpate::vdb
