// Level sets as meshes, and meshes as files that every reader reads back.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"
#include "support/error_of.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

using ::palpate::testing::TempFolder;

constexpr double kRadius = 0.015;
constexpr double kVoxel = 0.0005;

LevelSet baked(const Field& field) {
  BakeOptions options;
  options.voxel_size = kVoxel;
  return bake(field, options);
}

const Mesh& ballMesh() {
  static const Mesh mesh = surfaceMesh(baked(*sphere(Vec3(0.003, -0.02, 0.04), kRadius)));
  return mesh;
}

TEST(SurfaceMesh, BallIsClosedOutwardAndOnTheBall) {
  const Mesh& mesh = ballMesh();
  const MeshReport report = checkMesh(mesh);
  EXPECT_TRUE(report.isClosed());
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.flipped_edges, 0U);
  EXPECT_EQ(report.non_manifold_edges, 0U);
  // The cubic spline has an error below 1e-4 voxel at r / h = 30, and vertices one of a thousandth
  // of that.
  for (const Vec3& v : mesh.vertices) {
    ASSERT_NEAR(glm::length(v - Vec3(0.003, -0.02, 0.04)), kRadius, 1e-3 * kVoxel);
  }
  // Flat triangles between points of a ball are edge^2 / 8 r below it, with edges of up to 1.5
  // voxels.
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3.0);
  const double sag = std::pow(1.5 * kVoxel, 2.0) / (8.0 * kRadius);
  EXPECT_LT(report.volume, volume);
  EXPECT_GT(report.volume, volume * (1.0 - 3.0 * sag / kRadius));
}

TEST(SurfaceMesh, CavityKeepsItsWall) {
  const FieldPtr shell = subtract({sphere(Vec3(0.0), kRadius), sphere(Vec3(0.0), 0.5 * kRadius)});
  const MeshReport report = checkMesh(surfaceMesh(baked(*shell)));
  EXPECT_EQ(report.components, 2U);
  EXPECT_TRUE(report.isClosed());
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3.0) * (1.0 - 0.125);
  EXPECT_NEAR(report.volume, volume, 2e-3 * volume);
}

void expectSame(const Mesh& a, const Mesh& b, double tolerance) {
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  for (std::size_t t = 0; t < a.triangles.size(); ++t) {
    for (std::size_t n = 0; n < 3; ++n) {
      const Vec3 from = a.vertices[a.triangles[t][n]], to = b.vertices[b.triangles[t][n]];
      ASSERT_LE(glm::length(from - to), tolerance) << "triangle " << t << " corner " << n;
    }
  }
}

TEST(EncodeMesh, EveryFormatReadsBack) {
  const Mesh& mesh = ballMesh();
  const TempFolder folder;
  // 0.06 m from the origin: a float has a rounding of 4e-9 m there. Dividing and multiplying by the
  // unit rounds twice.
  struct {
    const char* extension;
    double unit, tolerance;
  } const cases[] = {{".stl", 1e-3, 8e-9},
                     {".stl", 1.0, 8e-9},
                     {".obj", 1e-3, 2e-17},
                     {".ply", 1e-2, 2e-17},
                     {".glb", 1.0, 8e-9}};
  for (const auto& c : cases) {
    SCOPED_TRACE(::testing::Message() << c.extension << " " << c.unit);
    const std::string bytes = encodeMesh(mesh, meshFormat(std::string("x") + c.extension), c.unit);
    const std::string path = folder.file(std::string("ball") + c.extension, bytes);
    const Mesh back = readMesh(path, c.unit);
    expectSame(mesh, back, c.tolerance);
    EXPECT_EQ(back.vertices.size(), mesh.vertices.size()) << "still welded";
  }
}

TEST(EncodeMesh, GlbIsInMetersWhateverTheUnit) {
  const Mesh& mesh = ballMesh();
  EXPECT_EQ(encodeMesh(mesh, MeshFormat::kGlb, 1e-3), encodeMesh(mesh, MeshFormat::kGlb, 1.0));
}

TEST(EncodeMesh, FilesOfFloatsHaveNoTriangleWithTwoCornersInOnePlace) {
  // Two vertices that are nearer to each other than floats at 0.1 m can show: the side between them
  // vanishes, with both its triangles.
  Mesh mesh = ballMesh();
  const auto [a, b, c] = mesh.triangles[7];
  for (Vec3& v : mesh.vertices) v += Vec3(0.1);
  mesh.vertices[b] = mesh.vertices[a] + Vec3(1e-11, 0.0, 0.0);
  const TempFolder folder;
  for (const char* name : {"ball.stl", "ball.glb"}) {
    const std::string path = folder.file(name, encodeMesh(mesh, meshFormat(name), 1.0));
    const Mesh back = readMesh(path, 1.0);
    EXPECT_EQ(back.triangles.size(), mesh.triangles.size() - 2) << name;
    EXPECT_EQ(back.dropped_triangles, 0U) << name;  // there was none to drop
    const MeshReport report = checkMesh(back);
    EXPECT_TRUE(report.isClosed()) << name;
    EXPECT_EQ(report.degenerate_triangles, 0U) << name;
  }
}

TEST(EncodeMesh, RefusesWhatItCannotWrite) {
  EXPECT_EQ(errorOf([] { (void)encodeMesh(Mesh{}, MeshFormat::kStl, 1.0); }).problem().code,
            "mesh.no_faces");
  for (const char* path : {"a.txt", "a.vdb", "plain", "a.stl/b", ""}) {
    EXPECT_EQ(errorOf([&] { (void)meshFormat(path); }).problem().code, "mesh.format") << path;
  }
  EXPECT_EQ(meshFormat("folder.obj/A.PLY"), MeshFormat::kPly);
}

}  // namespace
}  // namespace palpate::vdb
