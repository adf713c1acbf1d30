// Facets turned into a smooth surface before they are baked.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

constexpr double kDegree = std::numbers::pi / 180.0;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);

BakeOptions smoothed(double voxel, double degrees) {
  BakeOptions options = voxels(voxel);
  options.smooth_angle = degrees * kDegree;
  return options;
}

struct Feel {
  double value = 0.0;   ///< [m] RMS
  double normal = 0.0;  ///< [degree] RMS
  double jitter = 0.0;  ///< largest |n[i+1] - 2 n[i] + n[i-1]| along the path
};

/// Slides around a ball in steps of 0.2 mm.
Feel slide(const Field& field, double radius) {
  constexpr int kSteps = 6000;
  Feel feel;
  Vec3 before(0.0);
  Vec3 last(0.0);
  for (int i = 0; i < kSteps; ++i) {
    // A curve that covers the whole ball.
    const double turn = 0.2e-3 / radius * i;
    const double tilt = 0.03 * turn;
    const Vec3 out(std::cos(turn), std::sin(turn) * std::cos(tilt),
                   std::sin(turn) * std::sin(tilt));
    const FieldSample sample = field.sample(kCenter + radius * out);
    const Vec3 normal = glm::normalize(sample.gradient);
    const double angle = glm::length(glm::cross(normal, out)) / kDegree;
    feel.value += sample.value * sample.value / kSteps;
    feel.normal += angle * angle / kSteps;
    if (i > 1) feel.jitter = std::max(feel.jitter, glm::length(normal - 2.0 * last + before));
    before = std::exchange(last, normal);
  }
  feel.value = std::sqrt(feel.value);
  feel.normal = std::sqrt(feel.normal);
  return feel;
}

TEST(SmoothMesh, BallOfLargeFacetsFeelsLikeABall) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  // Facets of 2.4 voxels with R / h = 100 in slow runs, else of 4.8 voxels with 50.
  const double radius = slow ? 50e-3 : 25e-3;
  const Mesh mesh = ballMesh(kCenter, radius, slow ? 5 : 4);
  const Feel facets = slide(*gridField(bakeMesh(mesh, voxels(0.5e-3))), radius);
  const Feel smooth = slide(*gridField(bakeMesh(mesh, smoothed(0.5e-3, 30.0))), radius);
  RecordProperty("facets", std::to_string(facets.normal) + " degree");
  if (slow) {
    std::printf(
        "facets: %.2g um, %.3g degree, jitter %.2g\nsmooth: %.2g um, %.3g degree, jitter %.2g\n",
        facets.value * 1e6, facets.normal, facets.jitter, smooth.value * 1e6, smooth.normal,
        smooth.jitter);
  }
  EXPECT_GT(facets.normal, 0.3);
  EXPECT_LT(smooth.normal, 0.03);
  EXPECT_LT(smooth.normal, facets.normal / 20.0);
  EXPECT_LT(smooth.jitter, facets.jitter / 10.0);
  EXPECT_LT(smooth.value, facets.value / 20.0);
}

TEST(SmoothMesh, EdgesStaySharp) {
  // Twelve triangles with edges of 90 degrees: not a single float may change.
  const Mesh mesh = boxMesh(kCenter, Vec3(9.1e-3, 7.3e-3, 12.7e-3));
  const LevelSet plain = bakeMesh(mesh, voxels(0.5e-3));
  const LevelSet smooth = bakeMesh(mesh, smoothed(0.5e-3, 60.0));
  auto other = smooth.impl().grid->getConstAccessor();
  for (auto voxel = plain.impl().grid->cbeginValueOn(); voxel; ++voxel) {
    ASSERT_EQ(*voxel, other.getValue(voxel.getCoord()));
  }
}

/// A cylinder about z with `sides` flat sides.
Mesh prism(double radius, double height, std::uint32_t sides) {
  Mesh mesh;
  for (std::uint32_t n = 0; n < sides; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / sides;
    for (const double z : {-0.5 * height, 0.5 * height}) {
      mesh.vertices.push_back(kCenter +
                              Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
    }
  }
  mesh.vertices.push_back(kCenter - Vec3(0.0, 0.0, 0.5 * height));
  mesh.vertices.push_back(kCenter + Vec3(0.0, 0.0, 0.5 * height));
  for (std::uint32_t n = 0; n < sides; ++n) {
    const std::uint32_t a = 2 * n;
    const std::uint32_t b = 2 * ((n + 1) % sides);
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{a, b, b + 1}, {a, b + 1, a + 1}, {b, a, 2 * sides}, {a + 1, b + 1, 2 * sides + 1}});
  }
  return mesh;
}

TEST(SmoothMesh, RimOfACylinderIsRoundAndSharp) {
  const double radius = 10e-3;
  const double height = 12e-3;
  const FieldPtr exact = cylinder(kCenter, Vec3(0.0, 0.0, 1.0), radius, height);
  const auto worst = [&](const BakeOptions& options) {
    const LevelSet set = bakeMesh(prism(radius, height, 24), options);
    double most = 0.0;
    for (auto voxel = set.impl().grid->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      const double wanted = exact->value(Vec3(at.x(), at.y(), at.z()) * 0.5e-3);
      most = std::max(most, std::abs(*voxel * 1e-3 - wanted) / 0.5e-3);
    }
    return most;
  };
  // Flat sides of 15 degrees: R (1 - cos 7.5) = 0.17 voxel. Smoothed, the remaining error is 0.0045
  // voxel of the triangles themselves, plus the error of the surface's patches.
  EXPECT_GT(worst(voxels(0.5e-3, 3.0)), 0.15);
  BakeOptions options = smoothed(0.5e-3, 40.0);
  options.half_width = 3.0;
  EXPECT_LT(worst(options), 0.02);
}

TEST(SmoothMesh, OpenAndTurnedMeshesAreSmoothToo) {
  Mesh mesh = ballMesh(kCenter, 10e-3, 3);
  const Vec3 hole = mesh.vertices[mesh.triangles.back()[0]] - kCenter;
  mesh.triangles.resize(mesh.triangles.size() - 4);
  for (std::size_t n = 0; n < mesh.triangles.size(); n += 3) {
    std::swap(mesh.triangles[n][1], mesh.triangles[n][2]);
  }
  const auto worst = [&](const BakeOptions& options, double shell) {
    const LevelSet set = bakeMesh(mesh, options);
    double most = 0.0;
    for (auto voxel = set.impl().grid->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      const Vec3 p = Vec3(at.x(), at.y(), at.z()) * 0.5e-3 - kCenter;
      if (glm::dot(p, hole) > 0.8 * glm::length(p) * glm::length(hole)) continue;
      double wanted = glm::length(p) - 10e-3;
      if (shell > 0.0) wanted = std::abs(wanted) - 0.5 * shell;
      most = std::max(most, std::abs(*voxel * 1e-3 - wanted) / 0.5e-3);
    }
    return most;
  };
  // The facets' sagitta is 0.06 voxel.
  EXPECT_LT(worst(smoothed(0.5e-3, 30.0), 0.0), 0.01);
  BakeOptions shell = smoothed(0.5e-3, 30.0);
  shell.shell_thickness = 2e-3;
  EXPECT_LT(worst(shell, 2e-3), 0.01);
}

TEST(SmoothMesh, OptionsAndMemoryAreChecked) {
  const Mesh mesh = ballMesh(kCenter, 10e-3, 2);
  const auto code = [&](const BakeOptions& options) -> std::string {
    try {
      static_cast<void>(bakeMesh(mesh, options));
    } catch (const Error& error) {
      return error.problem().code;
    }
    return "";
  };
  EXPECT_EQ(code(smoothed(0.5e-3, -1.0)), "bake.smooth_angle");
  EXPECT_EQ(code(smoothed(0.5e-3, 181.0)), "bake.smooth_angle");
  EXPECT_EQ(code(smoothed(0.5e-3, std::nan(""))), "bake.smooth_angle");
  BakeOptions options = smoothed(0.05e-3, 30.0);
  options.max_memory = 20'000'000;
  EXPECT_EQ(code(options), "bake.memory");
}

}  // namespace
}  // namespace palpate::vdb
