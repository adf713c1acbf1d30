// Meshes as found in practice: holes; turned, doubled, missing and crossing triangles; thin plates;
// values that are not numbers. Each becomes the solid that a person expects, or an error that names
// the place.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

constexpr double kVoxel = 1e-3;
constexpr double kRadius = 20e-3;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);

/// 20480 triangles with edges of 1.2 voxels; nowhere more than 0.02 voxel inside the sphere.
Mesh ball() { return ballMesh(kCenter, kRadius, 5); }

using Distance = std::function<double(const Vec3&)>;

double toBall(const Vec3& p) { return glm::distance(p, kCenter) - kRadius; }

/// Expects that for every voxel in and around the mesh the sign is right, and the value within
/// `tolerance` voxels.
void expectSolid(const LevelSet& set, const Distance& exact, double tolerance,
                 const std::function<bool(const Vec3&)>& leave_out = {}) {
  const openvdb::FloatGrid& grid = *set.impl().grid;
  openvdb::CoordBBox block = grid.evalActiveVoxelBoundingBox();
  block.expand(9);
  auto accessor = grid.getConstAccessor();
  const double band = set.info().half_width * kVoxel;
  std::size_t wrong = 0;
  double worst = 0.0;
  for (auto at = block.begin(); at; ++at) {
    const Vec3 p = Vec3((*at).x(), (*at).y(), (*at).z()) * kVoxel;
    if (leave_out && leave_out(p)) continue;
    const double wanted = std::clamp(exact(p), -band, band);
    const double error = std::abs(accessor.getValue(*at) * 1e-3 - wanted) / kVoxel;
    worst = std::max(worst, error);
    if (error > tolerance) ++wrong;
  }
  EXPECT_EQ(wrong, 0U) << "worst: " << worst << " voxels";
}

LevelSet baked(const Mesh& mesh, MeshSign sign = MeshSign::kVote) {
  BakeOptions options = voxels(kVoxel, 3.0);
  options.mesh_sign = sign;
  return bakeMesh(mesh, options);
}

Problem refused(const Mesh& mesh, MeshSign sign = MeshSign::kVote) {
  try {
    static_cast<void>(baked(mesh, sign));
  } catch (const Error& error) {
    return error.problem();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// The ball without the triangles whose middle is within `width` / 2 of its highest point.
Mesh withHole(double width) {
  Mesh mesh = ball();
  const Vec3 top = kCenter + Vec3(0.0, 0.0, kRadius);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    return glm::distance(middle, top) < 0.5 * width;
  });
  return mesh;
}

TEST(MeshDefects, CleanBall) { expectSolid(baked(ball()), toBall, 0.02); }

void expectLid(double width) {
  const Mesh mesh = withHole(width * kVoxel);
  ASSERT_FALSE(checkMesh(mesh).isClosed());
  // A flat lid lies below the sphere by its sagitta; the triangles at its rim add one of their own.
  const double half = 0.5 * width + 1.0;
  expectSolid(baked(mesh), toBall, 0.05 + half * half / (2.0 * kRadius / kVoxel));
}

TEST(MeshDefects, HoleOfOneVoxel) { expectLid(1.0); }
TEST(MeshDefects, HoleOfTwoAndAHalfVoxels) { expectLid(2.5); }
TEST(MeshDefects, HoleOfSixVoxels) { expectLid(6.0); }
TEST(MeshDefects, HoleOfTwelveVoxels) { expectLid(12.0); }

TEST(MeshDefects, HalfABallIsRefusedUnlessTheWindingNumberDecides) {
  const Mesh bowl = withHole(1.8 * kRadius);
  const Problem problem = refused(bowl);
  EXPECT_EQ(problem.code, "mesh.open");
  EXPECT_NE(problem.message.find("1 hole"), std::string::npos) << problem.message;
  // With this rule the opening gets a lid.
  const auto set = baked(bowl, MeshSign::kWinding);
  const double lid = kCenter.z + kRadius * (1.0 - 0.9 * 0.9 / 2.0);
  EXPECT_GT(gridField(set)->value(Vec3(kCenter.x, kCenter.y, kCenter.z + kRadius)), 0.0);
  EXPECT_LT(gridField(set)->value(Vec3(kCenter.x, kCenter.y, lid - 2.0 * kVoxel)), 0.0);
}

TEST(MeshDefects, ThreePercentOfTheTrianglesMissing) {
  Mesh mesh = ball();
  std::mt19937 random(3);
  std::erase_if(mesh.triangles, [&](const auto&) { return random() % 100 < 3; });
  ASSERT_GT(checkMesh(mesh).boundary_edges, 1000U);
  // Single missing triangles are restored; where neighbors are missing too, the lid may be folded
  // along the other diagonals.
  expectSolid(baked(mesh), toBall, 0.1);
}

void expectTurnedBack(unsigned percent) {
  Mesh mesh = ball();
  std::mt19937 random(percent);
  for (auto& t : mesh.triangles) {
    if (random() % 100 < percent) std::swap(t[1], t[2]);
  }
  expectSolid(baked(mesh), toBall, 0.02);
}

TEST(MeshDefects, AllTrianglesTurned) { expectTurnedBack(100); }
TEST(MeshDefects, ATenthOfTheTrianglesTurned) { expectTurnedBack(10); }
TEST(MeshDefects, HalfOfTheTrianglesTurned) { expectTurnedBack(50); }

TEST(MeshDefects, TurnedMissingAndDoubledAtOnce) {
  Mesh mesh = ball();
  std::mt19937 random(5);
  std::erase_if(mesh.triangles, [&](const auto&) { return random() % 100 < 2; });
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    if (random() % 100 < 20) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (random() % 100 < 5) mesh.triangles.push_back(mesh.triangles[t]);
    if (random() % 100 < 5) {
      const auto [a, b, c] = mesh.triangles[t];
      mesh.triangles.push_back({b, a, c});
    }
  }
  expectSolid(baked(mesh), toBall, 0.1);
}

/// A torus with a ring of 12 mm and a tube of 16 mm: the tube passes through itself about the axis.
Mesh spindle() {
  Mesh mesh;
  constexpr std::uint32_t kAround = 128;
  constexpr std::uint32_t kTube = 96;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < kTube; ++k) {
      const double u = 2.0 * std::numbers::pi * (i + 0.3) / kAround;
      const double v = 2.0 * std::numbers::pi * (k + 0.3) / kTube;
      const double r = 12e-3 + 16e-3 * std::cos(v);
      mesh.vertices.push_back(kCenter +
                              Vec3(r * std::cos(u), r * std::sin(u), 16e-3 * std::sin(v)));
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t k) { return i % kAround * kTube + k % kTube; };
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t k = 0; k < kTube; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

/// Distance to the tube's circle in the half plane of p, or (side -1) to its mirror image beyond
/// the axis.
double toRing(const Vec3& p, double side) {
  const Vec3 q = p - kCenter;
  return std::hypot(std::hypot(q.x, q.y) - side * 12e-3, q.z) - 16e-3;
}

TEST(MeshDefects, SpindleIsNamedUnlessTheUserDecides) {
  const Mesh mesh = spindle();
  const Problem problem = refused(mesh);
  EXPECT_EQ(problem.code, "mesh.ambiguous");
  EXPECT_NE(problem.message.find("passes through itself at ("), std::string::npos)
      << problem.message;
  // At the lens's rim two walls meet: the larger of their distances is not the distance there. The
  // filled region is known to a voxel only.
  const auto by_rim = [](const Vec3& p) {
    return std::hypot(p.x - kCenter.x, p.y - kCenter.y) < 4e-3 && std::abs(p.z - kCenter.z) > 6e-3;
  };
  // With the flood fill: the solid that the outer circle sweeps. The facets' sagitta is 0.02 voxel.
  expectSolid(
      baked(mesh, MeshSign::kFlood), [](const Vec3& p) { return toRing(p, 1.0); }, 0.05, by_rim);
  // By the winding number the lens about the axis is hollow.
  expectSolid(
      baked(mesh, MeshSign::kWinding),
      [](const Vec3& p) { return std::max(toRing(p, 1.0), -toRing(p, -1.0)); }, 0.05, by_rim);
}

TEST(MeshDefects, OverlappingShellsAreOneSolid) {
  const Vec3 aside(15e-3, 4e-3, 2e-3);
  const Mesh mesh = together(ball(), ballMesh(kCenter + aside, kRadius, 5));
  const auto other = [&](const Vec3& p) { return toBall(p - aside); };
  const auto exact = [&](const Vec3& p) {
    // Outside, and inside away from the crease, the lesser of the two is the distance.
    return std::min(toBall(p), other(p));
  };
  // Inside near the crease, the nearest point is on the crease: farther than the walls of both
  // spheres.
  const auto near_crease = [&](const Vec3& p) {
    return exact(p) < 0.0 && std::abs(toBall(p) - other(p)) < 8e-3;
  };
  expectSolid(baked(mesh), exact, 0.05, near_crease);
}

TEST(MeshDefects, NoWallIsLeftInside) {
  const Vec3 aside(12e-3, 0.0, 0.0);
  const LevelSet set = baked(together(ball(), ballMesh(kCenter + aside, kRadius, 4)));
  auto accessor = set.impl().grid->getConstAccessor();
  for (int x = -4; x <= 16; ++x) {
    EXPECT_LT(accessor.getValue(openvdb::Coord(x, 0, 0)), -2.99F) << x;
  }
}

Mesh innerBall() { return ballMesh(kCenter, 12e-3, 4); }

double toHollow(const Vec3& p) { return std::max(toBall(p), 12e-3 - glm::distance(p, kCenter)); }

TEST(MeshDefects, NestedShellInnerReversedIsACavity) {
  expectSolid(baked(together(ball(), innerBall(), true)), toHollow, 0.05);
}

TEST(MeshDefects, NestedShellsOfOneOrientationAreSolid) {
  expectSolid(baked(together(ball(), innerBall())), toBall, 0.02);
}

TEST(MeshDefects, NestedShellsAllInsideOut) {
  Mesh turned = together(ball(), innerBall(), true);
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  expectSolid(baked(turned), toHollow, 0.05);
}

TEST(MeshDefects, IslandInACavity) {
  const Mesh island = ballMesh(kCenter, 6e-3, 4);
  expectSolid(
      baked(together(together(ball(), innerBall(), true), island)),
      [&](const Vec3& p) { return std::min(toHollow(p), glm::distance(p, kCenter) - 6e-3); }, 0.05);
}

TEST(MeshDefects, TheFloodKnowsNoHollows) {
  expectSolid(baked(together(ball(), innerBall(), true), MeshSign::kFlood), toBall, 0.02);
}

TEST(MeshDefects, RandomlyTurnedNestIsAmbiguous) {
  Mesh mesh = together(ball(), ballMesh(kCenter, 12e-3, 4), true);
  std::mt19937 random(7);
  for (auto& t : mesh.triangles) {
    if (random() % 2 == 0) std::swap(t[1], t[2]);
  }
  EXPECT_EQ(refused(mesh).code, "mesh.ambiguous");
}

Mesh plate(double thickness) { return boxMesh(kCenter, Vec3(30e-3, 30e-3, thickness * kVoxel)); }

float atCenter(const LevelSet& set) {
  return set.impl().grid->getConstAccessor().getValue(openvdb::Coord(0, 0, 0));
}

// The layer of voxels z = 0 is 0.23 voxels below a plate's middle.
TEST(MeshDefects, PlateOfTwoVoxels) { EXPECT_NEAR(atCenter(baked(plate(2.0))), 0.23 - 1.0, 1e-5); }
TEST(MeshDefects, PlateOfOneVoxel) { EXPECT_NEAR(atCenter(baked(plate(1.0))), 0.23 - 0.5, 1e-5); }
TEST(MeshDefects, PlateOfAThirdOfAVoxelIsRefused) {
  EXPECT_EQ(refused(plate(0.3)).code, "bake.empty");
}

/// Every triangle with its own corners, each off by up to `noise` [m].
Mesh soupOf(const Mesh& mesh, double noise) {
  Mesh soup;
  std::mt19937 random(19);
  std::uniform_real_distribution<double> any(-noise, noise);
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) {
      soup.vertices.push_back(mesh.vertices[v]);
      if (noise > 0.0) soup.vertices.back() += Vec3(any(random), any(random), any(random));
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(MeshDefects, DuplicateVertices) { expectSolid(baked(soupOf(ball(), 0.0)), toBall, 0.02); }

TEST(MeshDefects, VerticesThatAreAlmostTheSame) {
  // The diagonal of the mesh's box is 69 mm: corners are off by less than a millionth of that.
  expectSolid(baked(soupOf(ball(), 1.5e-8)), toBall, 0.02);
}

TEST(MeshDefects, ASmallGapOfAGoodMeshStays) {
  // Two closed cubes that are 5e-7 of their size apart are not welded, nor is a closed mesh with
  // edges that short.
  const Mesh two =
      together(boxMesh(Vec3(0.0), Vec3(10e-3)), boxMesh(Vec3(10e-3 + 1e-8, 0.0, 0.0), Vec3(10e-3)));
  const LevelSet set = baked(two);
  EXPECT_LT(gridField(set)->value(Vec3(3e-3, 0.0, 0.0)), 0.0);
  EXPECT_LT(gridField(set)->value(Vec3(7e-3, 0.0, 0.0)), 0.0);
}

TEST(MeshDefects, TrianglesWithoutArea) {
  Mesh mesh = ball();
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; t += 3) {
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles.push_back({a, b, a});
    mesh.triangles.push_back({c, c, c});
  }
  expectSolid(baked(mesh), toBall, 0.02);
}

TEST(MeshDefects, NeedlesThroughTheInside) {
  Mesh mesh = ball();
  std::mt19937 random(11);
  const auto any = [&] { return static_cast<std::uint32_t>(random() % 10000); };
  for (int n = 0; n < 200; ++n) {
    const std::uint32_t a = any();
    const std::uint32_t b = any();
    if (a == b) continue;
    mesh.vertices.push_back(0.4 * mesh.vertices[a] + 0.6 * mesh.vertices[b]);
    mesh.triangles.push_back({a, b, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  }
  expectSolid(baked(mesh), toBall, 0.02);
}

void expectNotFinite(double bad) {
  Mesh mesh = ball();
  mesh.vertices[4711].y = bad;
  const Problem problem = refused(mesh);
  EXPECT_EQ(problem.code, "mesh.not_finite");
  EXPECT_NE(problem.message.find("vertex 4711"), std::string::npos) << problem.message;
}

TEST(MeshDefects, NanVertexIsNamed) { expectNotFinite(std::numeric_limits<double>::quiet_NaN()); }

TEST(MeshDefects, InfiniteVertexIsNamed) {
  expectNotFinite(std::numeric_limits<double>::infinity());
  expectNotFinite(-std::numeric_limits<double>::infinity());
}

TEST(MeshDefects, VertexAMillionTimesTooFarIsNamed) {
  Mesh mesh = ball();
  mesh.vertices[4711] *= 1e6;
  const Problem problem = refused(mesh);
  EXPECT_EQ(problem.code, "mesh.outlier");
  EXPECT_NE(problem.message.find("vertex 4711"), std::string::npos) << problem.message;
}

TEST(MeshDefects, IndexOutOfRangeIsNamed) {
  Mesh mesh = ball();
  mesh.triangles[815][2] = 1000000;
  const Problem problem = refused(mesh);
  EXPECT_EQ(problem.code, "mesh.index");
  EXPECT_NE(problem.message.find("face 815"), std::string::npos) << problem.message;
}

TEST(MeshDefects, EmptyMeshIsRefused) { EXPECT_EQ(refused(Mesh{}).code, "mesh.no_faces"); }

TEST(MeshDefects, SingleTriangleIsOpenOrAShell) {
  Mesh mesh = ball();
  mesh.triangles.resize(1);
  EXPECT_EQ(refused(mesh).code, "mesh.open");
  BakeOptions options = voxels(kVoxel, 3.0);
  options.shell_thickness = 4e-3;
  const LevelSet shell = bakeMesh(mesh, options);
  const auto& t = mesh.triangles[0];
  const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
  EXPECT_NEAR(gridField(shell)->value(middle), -2e-3, 0.5e-3);
  EXPECT_GT(gridField(shell)->value(middle + Vec3(0.0, 0.0, 4e-3)), 0.0);
}

TEST(MeshDefects, TriangleSoupIsOpenOrAShell) {
  Mesh soup;
  std::mt19937 random(13);
  std::uniform_real_distribution<double> place(-kRadius, kRadius);
  for (std::uint32_t n = 0; n < 300; n += 3) {
    for (int k = 0; k < 3; ++k)
      soup.vertices.emplace_back(place(random), place(random), place(random));
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_EQ(refused(soup).code, "mesh.open");
  BakeOptions options = voxels(kVoxel, 3.0);
  options.shell_thickness = 4e-3;
  const FieldPtr shell = gridField(bakeMesh(soup, options));
  for (const auto& [a, b, c] : soup.triangles) {
    const Vec3 middle = (soup.vertices[a] + soup.vertices[b] + soup.vertices[c]) / 3.0;
    EXPECT_LT(shell->value(middle), -1e-3);
  }
}

TEST(MeshDefects, ShellAboutABall) {
  BakeOptions options = voxels(kVoxel, 3.0);
  options.shell_thickness = 6e-3;
  expectSolid(
      bakeMesh(ball(), options), [](const Vec3& p) { return std::abs(toBall(p)) - 3e-3; }, 0.03);
}

TEST(MeshDefects, VertexNoiseOfAQuarterVoxel) {
  Mesh mesh = ball();
  std::mt19937 random(17);
  std::uniform_real_distribution<double> noise(-0.25 * kVoxel, 0.25 * kVoxel);
  for (Vec3& v : mesh.vertices) v += Vec3(noise(random), noise(random), noise(random));
  expectSolid(baked(mesh), toBall, 0.45);
}

}  // namespace
}  // namespace palpate::vdb
