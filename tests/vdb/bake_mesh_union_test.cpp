// Solids that overlap, as in models assembled from parts: they become one exact surface, with
// nothing left inside.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"
#include "vdb/union_oracle.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

Mesh joined(const std::vector<Mesh>& parts) {
  Mesh all = parts.front();
  for (std::size_t n = 1; n < parts.size(); ++n) all = together(all, parts[n]);
  return all;
}

/// Checks every `step`th voxel of the band. The tolerance is the error that bakeMesh() promises,
/// and the same again where two walls are too near to each other to be told apart.
void expectExact(const LevelSet& set, const UnionOracle& oracle, std::uint64_t step) {
  const double voxel = set.info().voxel_size;
  double worst = 0.0;
  std::uint64_t n = 0;
  for (auto at = set.impl().grid->cbeginValueOn(); at; ++at) {
    if (n++ % step != 0) continue;
    const openvdb::Coord c = at.getCoord();
    const double exact = oracle.at(Vec3(c.x(), c.y(), c.z()) * voxel, 4.0 * voxel);
    worst = std::max(worst, std::abs(static_cast<double>(*at) * 1e-3 - exact) / voxel);
  }
  EXPECT_GT(n, 1000U);
  EXPECT_LT(worst, 2e-5) << "of a voxel";
}

Vec3 anywhere(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> any(-reach, reach);
  return {any(random), any(random), any(random)};
}

TEST(MeshUnion, OverlappingBallsAreExact) {
  std::mt19937 random(17);
  std::vector<Mesh> balls;
  for (int n = 0; n < 12; ++n) {
    balls.push_back(ballMesh(anywhere(random, 8e-3), 4e-3 + 1e-3 * (n % 5), 1));
  }
  expectExact(bakeMesh(joined(balls), voxels(1e-3, 3.0)), UnionOracle(balls), 61);
}

TEST(MeshUnion, LargeFacesThroughFineBallsAreExact) {
  // Faces of 40 voxels, cut along curves of hundreds of segments.
  std::vector<Mesh> parts{boxMesh(Vec3(0.3e-3, 0.1e-3, 0.2e-3), Vec3(20e-3, 16e-3, 12e-3)),
                          ballMesh(Vec3(1e-3, 0.0, 6e-3), 5e-3, 3),
                          ballMesh(Vec3(10e-3, 8e-3, -6e-3), 4e-3, 3)};
  expectExact(bakeMesh(joined(parts), voxels(0.5e-3, 3.0)), UnionOracle(parts), 211);
}

TEST(MeshUnion, CubesThatShareFacesAndEdgesAreExact) {
  // Faces in one plane, faces that cover half of each other, and an edge on a face.
  std::vector<Mesh> parts{boxMesh(Vec3(0.0), Vec3(10e-3)),
                          boxMesh(Vec3(10e-3, 2e-3, 0.0), Vec3(10e-3)),
                          boxMesh(Vec3(3e-3, 1e-3, 8e-3), Vec3(4e-3, 5e-3, 6e-3)),
                          boxMesh(Vec3(-5e-3, -5e-3, 0.0), Vec3(4e-3))};
  const LevelSet set = bakeMesh(joined(parts), voxels(0.73e-3, 3.0));
  expectExact(set, UnionOracle(parts), 3);
}

TEST(MeshUnion, AFanOfNeedlesThroughOneLineIsExact) {
  // A hundred wedges rotated about one axis: cuts that all pass through one point of a face.
  std::vector<Mesh> parts{boxMesh(Vec3(0.0), Vec3(16e-3, 16e-3, 6e-3))};
  for (int n = 0; n < 24; ++n) {
    // With different heights, because the oracle removes faces that share a plane from each other.
    Mesh blade = boxMesh(Vec3(0.0), Vec3(14e-3, 0.8e-3, 10e-3 + 0.06e-3 * n));
    const double turn = std::numbers::pi * n / 24.0 + 0.01;
    for (Vec3& v : blade.vertices) {
      v = {std::cos(turn) * v.x - std::sin(turn) * v.y, std::sin(turn) * v.x + std::cos(turn) * v.y,
           v.z};
    }
    parts.push_back(blade);
  }
  expectExact(bakeMesh(joined(parts), voxels(0.5e-3, 3.0)), UnionOracle(parts), 1009);
}

TEST(MeshUnion, NothingIsLeftInsideOfTwoHundredBalls) {
  std::mt19937 random(200);
  std::vector<Mesh> balls;
  std::vector<Vec3> centers;
  for (int n = 0; n < 200; ++n) {
    centers.push_back(anywhere(random, 12e-3));
    balls.push_back(ballMesh(centers.back(), 5e-3, 2));
  }
  const LevelSet set = bakeMesh(joined(balls), voxels(0.5e-3, 3.0));
  auto accessor = set.impl().grid->getConstAccessor();
  // A voxel that is deeper than the band in some ball is deeper than the band in the union.
  std::size_t seen = 0;
  for (const Vec3& center : centers) {
    for (int n = 0; n < 40; ++n) {
      const Vec3 p = center + anywhere(random, 1.5e-3);
      const openvdb::Coord at(static_cast<int>(std::lround(p.x / 0.5e-3)),
                              static_cast<int>(std::lround(p.y / 0.5e-3)),
                              static_cast<int>(std::lround(p.z / 0.5e-3)));
      const Vec3 voxel = 0.5e-3 * Vec3(at.x(), at.y(), at.z());
      // Facets are up to 2.5 % of the radius below the sphere.
      if (glm::distance(voxel, center) > 0.97 * 5e-3 - 1.5e-3) continue;
      ++seen;
      EXPECT_LE(accessor.getValue(at), -1.5F) << at;
    }
  }
  EXPECT_GT(seen, 3000U);
}

}  // namespace
}  // namespace palpate::vdb
