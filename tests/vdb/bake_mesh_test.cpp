// Level sets of meshes compared with closed forms and with brute force over all triangles.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "bake/facet.h"
#include "bake/leaf_distance.h"
#include "brick/instruction_set.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/scan_folder.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

/// Visits the value [m] of every voxel, active or not, in and around the shape.
template <typename Visit>
void forEachVoxel(const LevelSet& set, const Visit& visit) {
  const openvdb::FloatGrid& grid = *set.impl().grid;
  openvdb::CoordBBox block = grid.evalActiveVoxelBoundingBox();
  block.expand(9);
  auto accessor = grid.getConstAccessor();
  for (auto at = block.begin(); at; ++at) {
    float value = 0.0F;
    const bool active = accessor.probeValue(*at, value);
    const Vec3 p = Vec3((*at).x(), (*at).y(), (*at).z()) * set.info().voxel_size;
    visit(p, static_cast<double>(value) * 1e-3, active);
  }
}

/// Compares every voxel with the distance that `exact` gives.
template <typename Exact>
void expectDistances(const LevelSet& set, const Exact& exact) {
  const double band = set.info().half_width * set.info().voxel_size;
  std::size_t active_voxels = 0;
  forEachVoxel(set, [&](const Vec3& p, double value, bool active) {
    const double wanted = exact(p);
    // The error that bakeMesh() promises, and half a unit in the last place of the stored float.
    const double rounding = 1e-5 * set.info().voxel_size + std::abs(wanted) * 0x1p-23;
    active_voxels += active ? 1 : 0;
    if (std::abs(std::abs(wanted) - band) > rounding) {
      ASSERT_EQ(active, std::abs(wanted) < band) << p.x << ' ' << p.y << ' ' << p.z;
    }
    if (active) {
      ASSERT_NEAR(value, wanted, rounding) << p.x << ' ' << p.y << ' ' << p.z;
    } else {
      ASSERT_NEAR(std::abs(value), band, 1e-6 * band);
      ASSERT_EQ(std::signbit(value), wanted < 0.0) << p.x << ' ' << p.y << ' ' << p.z;
    }
  });
  EXPECT_EQ(active_voxels, set.info().active_voxels);
}

TEST(BakeMesh, CubeHoldsTheDistancesOfABox) {
  const Vec3 center(0.31e-3, -0.2e-3, 0.12e-3), size(9.1e-3, 7.3e-3, 12.7e-3);
  const FieldPtr exact = box(center, size);
  const LevelSet set = bakeMesh(boxMesh(center, size), voxels(0.5e-3, 3.0));
  expectDistances(set, [&](const Vec3& p) { return exact->value(p); });
}

TEST(BakeMesh, FacesInTheVoxelsAreHarmless) {
  // Faces, edges and corners lie exactly on voxel centers, where rays meet
  // edges.
  const FieldPtr exact = box(Vec3(0.0), Vec3(8e-3));
  const LevelSet set = bakeMesh(boxMesh(Vec3(0.0), Vec3(8e-3)), voxels(0.5e-3, 3.0));
  expectDistances(set, [&](const Vec3& p) { return exact->value(p); });
}

/// Distance from p to a triangle, computed in another way than in the bake: by its plane if p
/// projects into it, else by its sides.
double distanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const auto is_left = [&](const Vec3& from, const Vec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  if (is_left(a, b) && is_left(b, c) && is_left(c, a)) return std::abs(glm::dot(p - a, normal));
  double best = kInfinity;
  const std::vector<std::pair<Vec3, Vec3>> sides{{a, b}, {b, c}, {c, a}};
  for (const auto& [from, to] : sides) {
    const Vec3 along = to - from;
    const double t = std::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
    best = std::min(best, glm::distance(p, from + t * along));
  }
  return best;
}

/// Generalized winding number: the solid angle of the mesh over 4 pi, 1 inside and 0 outside.
double windingNumber(const Vec3& p, const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.vertices[i] - p, b = mesh.vertices[j] - p, c = mesh.vertices[k] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2.0 *
           std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                         glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

double signedDistance(const Vec3& p, const Mesh& mesh) {
  double best = kInfinity;
  for (const auto& [a, b, c] : mesh.triangles) {
    best =
        std::min(best, distanceToTriangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return std::abs(windingNumber(p, mesh)) > 0.5 ? -best : best;
}

TEST(BakeMesh, BallMatchesBruteForce) {
  const Mesh mesh = ballMesh(Vec3(0.2e-3, 0.1e-3, -0.3e-3), 3.5e-3, 2);
  expectDistances(bakeMesh(mesh, voxels(0.5e-3, 3.0)),
                  [&](const Vec3& p) { return signedDistance(p, mesh); });
}

TEST(BakeMesh, LargeMeshMatchesBruteForceHereAndThere) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const Mesh mesh = ballMesh(Vec3(0.2e-3, 0.1e-3, -0.3e-3), 20e-3, slow ? 8 : 5);
  const LevelSet set = bakeMesh(mesh, voxels(slow ? 0.1e-3 : 0.4e-3, 4.0));
  const openvdb::FloatGrid& grid = *set.impl().grid;
  const std::uint64_t every = set.info().active_voxels / 200;
  std::uint64_t n = 0;
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
    if (n++ % every != 0) continue;
    const openvdb::Coord at = voxel.getCoord();
    const Vec3 p = Vec3(at.x(), at.y(), at.z()) * set.info().voxel_size;
    ASSERT_NEAR(*voxel * 1e-3, signedDistance(p, mesh), 1e-5 * set.info().voxel_size);
  }
}

// Closed or not: unsigned distances to the nearest triangle, and shells of any thickness made from
// one such grid.
TEST(BakeMesh, UnsignedHasNoInside) {
  Mesh bowl = ballMesh(Vec3(0.2e-3, 0.1e-3, -0.3e-3), 4e-3, 2);
  for (const bool is_open : {false, true}) {
    if (is_open) bowl.triangles.resize(bowl.triangles.size() / 2);
    BakeOptions options = voxels(0.5e-3, 6.0);
    options.mesh_sign = MeshSign::kUnsigned;
    const LevelSet set = bakeMesh(bowl, options);
    EXPECT_EQ(set.impl().grid->getGridClass(), openvdb::GRID_UNKNOWN);
    EXPECT_EQ(set.info().metadata.at(kDistanceKey), kUnsignedDistance);
    const auto distance = [&](const Vec3& p) { return std::abs(signedDistance(p, bowl)); };
    expectDistances(set, distance);
    const FieldPtr shell = offset(gridField(set), 1e-3);
    for (const auto& [a, b, c] : bowl.triangles) {
      const Vec3 middle = (bowl.vertices[a] + bowl.vertices[b] + bowl.vertices[c]) / 3.0;
      EXPECT_LT(shell->value(middle), -0.7e-3);
      for (const double off : {-1e-3, 1e-3}) {
        const Vec3 p =
            middle + off * glm::normalize(glm::cross(bowl.vertices[b] - bowl.vertices[a],
                                                     bowl.vertices[c] - bowl.vertices[a]));
        // Ridges of the distance, at edges of the bowl's facets and at its rim, are rounded within
        // a tenth of a voxel.
        EXPECT_NEAR(shell->value(p), distance(p) - 1e-3, 0.05e-3);
      }
    }
    options.shell_thickness = 2e-3;
    EXPECT_THROW((void)bakeMesh(bowl, options), Error);
  }
}

TEST(BakeMesh, ThreadsDoNotMatter) {
  const Mesh mesh = together(ballMesh(Vec3(0.0), 8e-3, 3), ballMesh(Vec3(6e-3), 8e-3, 3));
  const auto bake_with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return bakeMesh(mesh, voxels(0.3e-3, 3.0));
  };
  const LevelSet one = bake_with(1);
  const LevelSet four = bake_with(4);
  ASSERT_TRUE(one.impl().grid->tree().hasSameTopology(four.impl().grid->tree()));
  auto other = four.impl().grid->getConstAccessor();
  for (auto voxel = one.impl().grid->cbeginValueAll(); voxel; ++voxel) {
    ASSERT_EQ(*voxel, other.getValue(voxel.getCoord()));
  }
}

/// The squared distances that a kernel finds in the leaf about the origin, compared with brute
/// force over `mesh` [voxels].
void expectSquares(void (*find_squares)(const LeafQuery&) noexcept, const Mesh& mesh) {
  std::vector<Facet> facets;
  for (const auto& [a, b, c] : mesh.triangles) {
    facets.push_back(makeFacet(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  const double half_width = 4.0;
  LeafScratch scratch;
  std::vector<float> squares(512);
  find_squares(makeQuery(facets, half_width, scratch, squares.data()));
  int near = 0;
  for (int n = 0; n < 512; ++n) {
    const Vec3 p = Vec3(n / 64, n / 8 % 8, n % 8) - 3.5;
    const double wanted = std::abs(signedDistance(p, mesh));
    const double found = std::sqrt(squares[static_cast<std::size_t>(n)]);
    // "The error of a square is some 1e-6 voxel times the distance"; outside the band only a lower
    // bound is known.
    if (wanted < half_width) {
      ++near;
      EXPECT_NEAR(found, wanted, 1e-5) << n;
    } else {
      EXPECT_GE(found, half_width - 1e-5) << n;
    }
  }
  EXPECT_GT(near, 20);
}

TEST(BakeMesh, EveryKernelMatchesBruteForce) {
  const Mesh mesh = ballMesh(Vec3(1.0, 2.0, -3.0), 9.0, 2);
  expectSquares(findSquaresBase, mesh);
#if defined(__x86_64__)
  if (isSupported(InstructionSet::kAvx2)) expectSquares(findSquaresAvx2, mesh);
#endif
}

TEST(BakeMesh, CavityIsOutside) {
  const Mesh mesh = together(ballMesh(Vec3(0.0), 6e-3, 1), ballMesh(Vec3(0.5e-3), 3e-3, 1),
                             /*inside_out=*/true);
  const LevelSet set = bakeMesh(mesh, voxels(0.7e-3, 2.0));
  expectDistances(set, [&](const Vec3& p) { return signedDistance(p, mesh); });
}

TEST(BakeMesh, OverlappingPartsAreOneSolid) {
  const Mesh mesh = together(ballMesh(Vec3(0.0), 5e-3, 3), ballMesh(Vec3(4e-3, 0, 0), 5e-3, 3));
  const LevelSet set = bakeMesh(mesh, voxels(0.5e-3, 3.0));
  const FieldPtr field = gridField(set);
  for (const double x : {-4e-3, 0.0, 2e-3, 4e-3, 8e-3}) {
    EXPECT_LT(field->value(Vec3(x, 0.0, 0.0)), 0.0) << x;
  }
  for (const Vec3& p : {Vec3(-6e-3, 0, 0), Vec3(10e-3, 0, 0), Vec3(2e-3, 5.5e-3, 0)}) {
    EXPECT_GT(field->value(p), 0.0);
  }
}

TEST(BakeMesh, TurnedTrianglesDoNotMatter) {
  const Mesh good = ballMesh(Vec3(0.1e-3), 3.5e-3, 1);
  Mesh inside_out = good, some_turned = good;
  for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  for (std::size_t i = 0; i < good.triangles.size(); i += 7) {
    std::swap(some_turned.triangles[i][1], some_turned.triangles[i][2]);
  }
  for (const Mesh& mesh : {inside_out, some_turned}) {
    expectDistances(bakeMesh(mesh, voxels(0.5e-3, 3.0)),
                    [&](const Vec3& p) { return signedDistance(p, good); });
  }
}

TEST(BakeMesh, EmptyTrianglesAreHarmless) {
  // The edge from corner 0 to corner 1 gets a middle vertex on one side only,
  // closed by a triangle without area.
  Mesh mesh = boxMesh(Vec3(0.0), Vec3(7e-3));
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.triangles[4] = {0, 8, 4};  // was {0, 1, 4}
  mesh.triangles.push_back({8, 1, 4});
  mesh.triangles.push_back({0, 1, 8});
  ASSERT_TRUE(checkMesh(mesh).isClosed());
  ASSERT_EQ(checkMesh(mesh).degenerate_triangles, 1U);
  const FieldPtr exact = box(Vec3(0.0), Vec3(7e-3));
  expectDistances(bakeMesh(mesh, voxels(0.4e-3, 3.0)),
                  [&](const Vec3& p) { return exact->value(p); });
}

Error bakeError(const Mesh& mesh, const BakeOptions& options) {
  try {
    static_cast<void>(bakeMesh(mesh, options));
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return inputError("none", "none");
}

TEST(BakeMesh, OpenMeshIsRefusedWithAPlace) {
  Mesh mesh = boxMesh(Vec3(0.0), Vec3(10e-3));
  mesh.source = "open.stl";
  mesh.triangles.erase(mesh.triangles.begin() + 2,
                       mesh.triangles.begin() + 4);  // the face z = 5 mm
  const Error error = bakeError(mesh, voxels(0.5e-3));
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "mesh.open");
  EXPECT_EQ(error.problem().file, "open.stl");
  EXPECT_NE(error.problem().message.find("1 hole, the largest 14.1421 mm across"),
            std::string::npos)
      << error.what();
  EXPECT_NE(error.problem().message.find("5 mm)"), std::string::npos) << error.what();
}

TEST(BakeMesh, BadMeshesAreRefused) {
  EXPECT_EQ(bakeError(Mesh{}, voxels(0.5e-3)).problem().code, "mesh.no_faces");
  Mesh mesh = boxMesh(Vec3(0.0), Vec3(10e-3));
  mesh.triangles[3][1] = 8;
  EXPECT_EQ(bakeError(mesh, voxels(0.5e-3)).problem().code, "mesh.index");
  mesh = boxMesh(Vec3(0.0), Vec3(10e-3));
  mesh.vertices[5].y = std::nan("");
  EXPECT_EQ(bakeError(mesh, voxels(0.5e-3)).problem().code, "mesh.not_finite");
  // One vertex a million times too far out: refused at once, where OpenVDB
  // works for minutes.
  mesh = boxMesh(Vec3(0.0), Vec3(10e-3));
  mesh.vertices[7] *= 1e6;
  EXPECT_EQ(bakeError(mesh, voxels(0.5e-3)).problem().code, "mesh.outlier");
  EXPECT_EQ(bakeError(boxMesh(Vec3(0.0), Vec3(100.0)), voxels(0.5e-3)).problem().code,
            "bake.memory");
  EXPECT_EQ(bakeError(boxMesh(Vec3(0.0), Vec3(1e30)), voxels(0.5e-3)).kind(),
            ErrorKind::kOperation);
  // A plate far thinner than a voxel, between two layers of voxels.
  const Error thin =
      bakeError(boxMesh(Vec3(0.0, 0.0, 0.5e-3), Vec3(20e-3, 20e-3, 0.1e-3)), voxels(1e-3));
  EXPECT_EQ(thin.problem().code, "bake.empty");
}

TEST(BakeMesh, CanBeStopped) {
  const Mesh mesh = ballMesh(Vec3(0.0), 10e-3, 4);
  int calls = 0;
  const auto here = std::this_thread::get_id();
  static_cast<void>(bakeMesh(mesh, voxels(0.2e-3), [&](std::string_view, double) {
    EXPECT_EQ(std::this_thread::get_id(), here);
    ++calls;
    return true;
  }));
  EXPECT_GT(calls, 1);
  for (const int stop_at : {0, 1}) {
    calls = 0;
    try {
      static_cast<void>(bakeMesh(mesh, voxels(0.2e-3),
                                 [&](std::string_view, double) { return calls++ < stop_at; }));
      ADD_FAILURE() << "was not stopped";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
    }
    EXPECT_EQ(calls, stop_at + 1);
  }
}

TEST(BakeMesh, RealMeshesBake) {
  const std::string folder = palpate::testing::scanPath("meshes/");
  PALPATE_NEEDS_SCAN(folder);
  struct Known {
    const char* name;
    double unit, voxel;  // [m]
  };
  for (const Known& known : {Known{"brain_region.stl", 1e-3, 0.5e-3},
                             {"footbones.ply", 10e-3, 0.7e-3},
                             {"brain_region2.stl", 1e-3, 0.5e-3}}) {
    const Mesh mesh = readMesh(folder + known.name, known.unit);
    const LevelSet set = bakeMesh(mesh, voxels(known.voxel, 3.0));
    double inside = 0.0;  // [m^3], each voxel by its share
    forEachVoxel(set, [&](const Vec3&, double value, bool) {
      inside += std::clamp(0.5 - value / known.voxel, 0.0, 1.0);
    });
    inside *= std::pow(known.voxel, 3.0);
    // A voxel's share is linear in its distance: exact for planes, second order
    // for curved faces.
    EXPECT_NEAR(inside / checkMesh(mesh).volume, 1.0, 0.02) << known.name;
  }
}

}  // namespace
}  // namespace palpate::vdb
