// Meshes of a real scan, written, read and checked: nuclei from Debian's atlas of a brain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "palpate/vdb/mesh.h"
#include "palpate/vdb/mesh_defects.h"
#include "support/temp_file.h"
#include "vdb/debian_scans.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

constexpr double kMm = 1e-3;

TEST(ScannedMesh, IsClosedAndOfOnePartInEveryFormat) {
  const TempFolder folder;
  const Image brain = test::deepBrain();
  for (const int label : {73, 75, 77}) {
    const Mesh made = test::nucleusMesh(label);
    const auto voxels = static_cast<double>(
        std::count(brain.values.begin(), brain.values.end(), static_cast<float>(label)));
    for (const auto& [name, format] :
         {std::pair("a.stl", MeshFormat::kStl), std::pair("a.obj", MeshFormat::kObj),
          std::pair("a.ply", MeshFormat::kPly)}) {
      SCOPED_TRACE(name);
      const Mesh mesh = readMesh(folder.file(name, encodeMesh(made, format, kMm)), kMm);
      const MeshReport report = checkMesh(mesh);
      EXPECT_EQ(mesh.triangles.size(), made.triangles.size());
      EXPECT_TRUE(report.isClosed());
      EXPECT_EQ(report.flipped_edges, 0U);
      EXPECT_EQ(report.components, 1U);
      // The surface encloses the volume of the voxels of 1 mm^3 within a percent.
      EXPECT_NEAR(report.volume * 1e9 / voxels, 1.0, 0.01);
      const MeshDefects defects = findDefects(mesh);
      EXPECT_EQ(defects.parts, 1U);
      EXPECT_EQ(defects.boundary_edges, 0U);
      EXPECT_EQ(defects.turned_triangles, 0U);
      EXPECT_EQ(defects.inside_out_parts, 0U);
    }
  }
}

/// [voxels] Distance of a point from the nearest face between a voxel of the label and one of
/// another label.
double offBorder(const Image& image, float label, const Vec3& p) {
  const Vec3 index = image.toIndex(p);
  const auto is_label = [&](const Vec3& v) {
    for (int a = 0; a < 3; ++a) {
      if (v[a] < 0 || v[a] > image.size[static_cast<std::size_t>(a)] - 1) return false;
    }
    return image.at(static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z)) == label;
  };
  double nearest = 9.0;
  for (int n = 0; n < 125; ++n) {
    const Vec3 a = glm::round(index) + Vec3(n % 5, n / 5 % 5, n / 25) - 2.0;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 b = a;
      b[axis] += 1.0;
      if (is_label(a) == is_label(b)) continue;
      // The face is a square as wide as a voxel.
      Vec3 to = glm::abs(index - 0.5 * (a + b));
      for (int x = 0; x < 3; ++x) to[x] = std::max(to[x] - (x == axis ? 0.0 : 0.5), 0.0);
      nearest = std::min(nearest, glm::length(to));
    }
  }
  return nearest;
}

// In the form in which 3D Slicer writes models: legacy VTK, x to the left and y to the back.
TEST(ScannedMesh, AModelInLpsLiesOnItsLabels) {
  const TempFolder folder;
  const Image brain = test::deepBrain();
  const Mesh made = test::nucleusMesh(77);
  std::string text =
      "# vtk DataFile Version 3.0\n3D Slicer output. SPACE=LPS\nASCII\nDATASET POLYDATA\nPOINTS " +
      std::to_string(made.vertices.size()) + " double\n";
  char line[128];
  for (const Vec3& v : made.vertices) {
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", -v.x / kMm, -v.y / kMm, v.z / kMm);
    text += line;
  }
  text += "POLYGONS " + std::to_string(made.triangles.size()) + " " +
          std::to_string(4 * made.triangles.size()) + "\n";
  for (const auto& [a, b, c] : made.triangles) {
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  const Mesh mesh = readMesh(folder.file("thalamus.vtk", text), kMm);
  ASSERT_EQ(mesh.vertices.size(), made.vertices.size());
  EXPECT_TRUE(mesh.space_is_stated);
  EXPECT_GT(checkMesh(mesh).volume, 0.0);  // rotated about z, not mirrored
  double worst = 0.0;
  for (const Vec3& v : mesh.vertices) worst = std::max(worst, offBorder(brain, 77.0F, v));
  std::printf("  %zu vertices, %.2f voxel from the voxels' faces at most\n", mesh.vertices.size(),
              worst);
  // Smooth walls cut off the steps of voxels, but voxel centers, half a voxel from each face, stay
  // on their side.
  EXPECT_LT(worst, 0.75);
}

}  // namespace
}  // namespace palpate::vdb
