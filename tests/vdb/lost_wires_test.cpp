// Wires and crumbs thinner than their voxels: reported if the grid has lost them, and only then.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

constexpr double kVoxel = 1e-3;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);
const Vec3 kSlanted = glm::normalize(Vec3(0.36, 0.48, 0.8));

/// The grid's message about parts that it has lost.
std::string lostParts(const LevelSet& set) {
  const auto found = set.info().metadata.find("lost_parts");
  return found == set.info().metadata.end() ? "" : found->second;
}
std::string lostParts(const Mesh& mesh) { return lostParts(bakeMesh(mesh, voxels(kVoxel, 3.0))); }
std::string lostParts(const FieldPtr& field) {
  return lostParts(bake(*field, voxels(kVoxel, 3.0)));
}

/// A tube with `sides` flat sides along a path of points, closed at both ends.
Mesh tube(const std::vector<Vec3>& path, double radius, std::uint32_t sides) {
  Mesh mesh;
  const auto count = static_cast<std::uint32_t>(path.size());
  Vec3 u = std::abs(glm::normalize(path[1] - path[0]).x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  for (std::uint32_t n = 0; n < count; ++n) {
    const Vec3 along = glm::normalize(path[std::min(n + 1, count - 1)] - path[n == 0 ? 0 : n - 1]);
    u = glm::normalize(u - glm::dot(u, along) * along);
    const Vec3 v = glm::cross(along, u);
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / sides;
      mesh.vertices.push_back(path[n] + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  for (std::uint32_t n = 0; n + 1 < count; ++n) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const std::uint32_t next = (k + 1) % sides;
      const std::uint32_t a = n * sides;
      const std::uint32_t b = a + sides;
      mesh.triangles.push_back({a + k, a + next, b + next});
      mesh.triangles.push_back({a + k, b + next, b + k});
    }
  }
  for (std::uint32_t k = 1; k + 1 < sides; ++k) {
    mesh.triangles.push_back({0, k + 1, k});
    const std::uint32_t last = (count - 1) * sides;
    mesh.triangles.push_back({last, last + k, last + k + 1});
  }
  return mesh;
}

Mesh rod(const Vec3& from, const Vec3& to, double diameter, std::uint32_t sides = 12) {
  return tube({from, to}, 0.5 * diameter, sides);
}

/// [m] The place that a message names.
Vec3 placeIn(const std::string& message) {
  Vec3 p(0.0);
  const std::size_t at = message.find("near (");
  EXPECT_NE(at, std::string::npos) << message;
  if (at == std::string::npos) return p;
  EXPECT_EQ(std::sscanf(message.c_str() + at, "near (%lf mm, %lf mm, %lf mm)", &p.x, &p.y, &p.z), 3)
      << message;
  return 1e-3 * p;
}

double distanceToLine(const Vec3& p, const Vec3& from, const Vec3& along) {
  return glm::length(glm::cross(p - from, along));
}

TEST(LostWires, AWireBetweenTwoBallsIsToldWithItsPlace) {
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, 0, 1), kSlanted}) {
    const Mesh balls = together(ballMesh(kCenter + 14e-3 * along, 6e-3, 3),
                                ballMesh(kCenter - 14e-3 * along, 6e-3, 3));
    EXPECT_EQ(lostParts(balls), "");
    for (const double diameter : {0.05, 0.2, 0.5}) {
      for (const std::uint32_t sides : {3U, 4U, 12U}) {
        SCOPED_TRACE(std::to_string(diameter) + " mm, " + std::to_string(sides) + " sides");
        const std::string told = lostParts(together(
            balls, rod(kCenter - 12e-3 * along, kCenter + 12e-3 * along, diameter * 1e-3, sides)));
        ASSERT_EQ(told.find("wires, the thickest 0."), 0U) << told;
        const Vec3 place = placeIn(told);
        EXPECT_LT(distanceToLine(place, kCenter, along), 0.5e-3 * diameter) << told;
        EXPECT_LT(std::abs(glm::dot(place - kCenter, along)), 12e-3) << told;
      }
    }
    // A rod of two voxels contains a voxel in every cross section.
    const Mesh thick = rod(kCenter - 12e-3 * along, kCenter + 12e-3 * along, 2e-3, 24);
    EXPECT_EQ(lostParts(together(balls, thick)), "");
  }
}

TEST(LostWires, AStubAHelixAHandleAndARibbonAreTold) {
  const Mesh ball = ballMesh(kCenter, 8e-3, 3);
  const auto is_told = [&](const Mesh& mesh, const char* what) {
    const std::string told = lostParts(together(ball, mesh));
    EXPECT_EQ(told.find("wires"), 0U) << what << told;
  };
  is_told(rod(kCenter, kCenter + 20e-3 * kSlanted, 0.4e-3), "one end in the ball");
  is_told(rod(kCenter + 12e-3 * kSlanted, kCenter + 24e-3 * kSlanted, 0.4e-3), "free");
  std::vector<Vec3> helix;
  std::vector<Vec3> handle;
  for (int n = 0; n <= 80; ++n) {
    const double angle = 0.2 * n;
    helix.push_back(kCenter +
                    Vec3(13e-3 * std::cos(angle), 13e-3 * std::sin(angle), 0.8e-3 * angle - 5e-3));
    const double turn = std::numbers::pi * (n / 80.0 - 0.5);
    handle.push_back(kCenter + Vec3(6e-3 + 8e-3 * std::cos(turn), 0.0, 5e-3 * std::sin(turn)));
  }
  is_told(tube(helix, 0.15e-3, 6), "helix");
  is_told(tube(handle, 0.2e-3, 6), "handle");
  // Too narrow for a plate, which must go on in all four directions.
  is_told(boxMesh(kCenter + Vec3(0.27e-3, 0.67e-3, 14e-3), Vec3(3e-3, 0.3e-3, 20e-3)), "ribbon");
}

/// A cone of at most a right angle is not a wire, however much of its tip is lost.
TEST(LostWires, TipsAndEdgesAreNone) {
  for (const double half_angle : {3.0, 6.0, 15.0, 30.0}) {
    const double radius = 20e-3 * std::tan(half_angle * std::numbers::pi / 180.0);
    EXPECT_EQ(lostParts(place(cone(kCenter, Vec3(0, 0, 1), radius, 20e-3),
                              {glm::mat3_cast(glm::angleAxis(0.7, kSlanted)), Vec3(0.0)})),
              "")
        << half_angle;
  }
  EXPECT_EQ(lostParts(boxMesh(kCenter, Vec3(10e-3, 7e-3, 5e-3))), "");
}

TEST(LostWires, CrumbsAreToldWithTheirPlace) {
  const Mesh ball = ballMesh(kCenter, 8e-3, 3);
  const auto with = [&](const Mesh& other) { return lostParts(together(ball, other)); };
  const Vec3 between(14.5e-3, 0.5e-3, 0.5e-3);  // as far from all voxels as possible
  for (const double diameter : {0.02e-3, 0.3e-3, 0.8e-3}) {
    const std::string told = with(ballMesh(between, 0.5 * diameter, 2));
    EXPECT_EQ(told.find("1 separate part"), 0U) << told;
    EXPECT_LT(glm::distance(placeIn(told), between), 0.5 * diameter) << told;
  }
  // A small plate, and a short rod.
  EXPECT_NE(with(boxMesh(between, Vec3(3e-3, 0.4e-3, 2e-3))), "");
  EXPECT_NE(with(rod(between, between + Vec3(1.5e-3, 0.0, 0.0), 0.4e-3)), "");
  // Two crumbs, of which the message names the larger one.
  const Vec3 other = between + Vec3(0.0, 9e-3, 0.0);
  const std::string two = with(together(ballMesh(between, 0.1e-3, 2), ballMesh(other, 0.3e-3, 2)));
  EXPECT_EQ(two.find("2 separate parts"), 0U) << two;
  EXPECT_LT(glm::distance(placeIn(two), other), 0.3e-3) << two;
  // A part that contains a voxel is not lost.
  EXPECT_EQ(with(ballMesh(between, 0.9e-3, 2)), "");
  EXPECT_EQ(with(ballMesh(between + Vec3(0.4e-3), 0.4e-3, 2)), "");
}

TEST(LostWires, FieldsTellThemToo) {
  const FieldPtr ball = sphere(kCenter, 8e-3);
  for (const double diameter : {0.2e-3, 0.5e-3}) {
    const std::string told =
        lostParts(unite({ball, capsule(kCenter, kCenter + 20e-3 * kSlanted, 0.5 * diameter)}));
    ASSERT_EQ(told.find("wires"), 0U) << diameter << told;
    EXPECT_LT(distanceToLine(placeIn(told), kCenter, kSlanted), 0.5 * diameter) << told;
  }
  EXPECT_EQ(lostParts(unite({ball, capsule(kCenter, kCenter + 20e-3 * kSlanted, 1e-3)})), "");
  const Vec3 between(14.5e-3, 0.5e-3, 0.5e-3);
  const std::string told = lostParts(unite({ball, sphere(between, 0.3e-3)}));
  EXPECT_EQ(told.find("1 separate part"), 0U) << told;
  EXPECT_LT(glm::distance(placeIn(told), between), 0.3e-3) << told;
}

}  // namespace
}  // namespace palpate::vdb
