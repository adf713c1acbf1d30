// Shaded walls where surfaces end at edges: the stored energy has folds there, and no energy is
// gained.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "lib/render/energy_loop.h"
#include "palpate/contact/felt_height.h"
#include "support/sanitized.h"

namespace palpate::test {
namespace {

void expectNothingGiven(const std::string& what, const ScenePtr& scene, const EnergyLoop& loop) {
  const Vec3 start = mm(0, 0, 40);
  EnergyGiven given = energyGiven(scene, start, loop, 32'000);
  // Two step counts may have the same error.
  if (given.work > 1e-9 + given.change) given = energyGivenAtLast(scene, start, loop);
  EXPECT_LE(given.work, 1e-9 + given.change) << what;
}

std::string list(const Vec3& v) {
  return "[" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + "]";
}

std::string halfSpaceText(const Vec3& normal) {
  char out[128];
  std::snprintf(out, sizeof out, "{half_space: {point: [0, 0, 0], normal: [%.17g, %.17g, %.17g]}}",
                normal.x, normal.y, normal.z);
  return out;
}

/// Two boxes that cross, each shaded by its own shape: where the edge between their tops ends at a
/// face of one, the energy of the other's top is suddenly added. When that was counted like a jump
/// of springs alone, it gave up to 0.24 mJ a lap.
TEST(ShadedWalls, WhatComesIntoPlayWhereTheirEdgeEndsIsCounted) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials: {m: {stiffness: 1000 N/m, shading: 0.788649}}
layers:
  - {name: b, inside: {transform: {field: {box: {center: [0.980288, -0.126776, -2.953173], size: [3.111457, 3.334048, 5.906345]}}, rotate: {axis: [0.001207, 0.677929, 0.735126], degrees: 6.222894}}}, wall: m}
  - {name: a, inside: {box: {center: [0.605069, 3.400626, -3.145692], size: [7.246815, 7.560652, 6.291384]}}, wall: m}
)");
  EnergyLoop loop;
  loop.center = mm(-0.138606, -0.308782, -0.544251);
  loop.wave = {mm(-0.159539, -0.141285, 0.037784), mm(-0.170604, 0.015125, 0.300868),
               mm(-0.143833, 0.440138, -0.212421), mm(0.409577, 0.156725, 0.655969)};
  expectNothingGiven("where an edge ends", scene, loop);
  const auto renderer = makeRenderer(scene);
  for (int i = 0; i <= 4000; ++i) {
    (void)renderer->update({loop.at(i / 4000.0), Vec3(0.0)});
  }
  // The energy is added suddenly twice in this lap, at up to 1.4 mm of depth, and is counted.
  EXPECT_GT(renderer->sourceWork(), 1e-4);
}

/// Boxes of any size and tilt, and loops around places where their surfaces cross.
TEST(ShadedWalls, WhereTwoBoxesCrossGiveNoEnergy) {
  const int scenes = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 200 : kSanitized ? 2 : 6;
  for (int i = 0; i < scenes; ++i) {
    Random random(900 + static_cast<std::uint64_t>(i));
    const auto box = [&] {
      const double x = random.uniform(3.0, 9.0);
      const double y = random.uniform(3.0, 9.0);
      const double z = random.uniform(3.0, 9.0);
      const Vec3 center(random.uniform(-0.5, 0.5) * x, random.uniform(-0.5, 0.5) * y, -0.5 * z);
      return "{transform: {field: {box: {center: " + list(center) +
             ", size: " + list(Vec3(x, y, z)) + "}}, rotate: {axis: " + list(random.direction()) +
             ", degrees: " + std::to_string(random.uniform(0.0, 40.0)) + "}}}";
    };
    const std::string one = box();
    const std::string other = box();
    const std::string text =
        "palpate: 1\nlength: mm\nmaterials: {m: {stiffness: 1000 N/m, shading: " +
        std::to_string(random.uniform(0.3, 1.5)) + "}}\nlayers:\n  - {name: b, inside: " + one +
        ", wall: m}\n  - {name: a, inside: " + other + ", wall: m}\n";
    const ScenePtr scene = sceneOf(text);
    for (int k = 0; k < 4; ++k) {
      Vec3 at = random.uniform(-1.2e-3, 0.3e-3) * Vec3(0, 0, 1) + 1e-3 * random.direction();
      for (int step = 0; step < 60; ++step) {
        for (const RegionId region : {RegionId{1}, RegionId{2}}) {
          const FieldSample s = scene->regions()[region].field->sample(at);
          at -= 0.5 * s.value * s.gradient;
        }
      }
      EnergyLoop loop = randomLoop(random, at, 0.05e-3, 0.7e-3);
      loop = worstLoop(scene, mm(0, 0, 40), loop, 0.2e-3, 4, random);
      expectNothingGiven("scene " + std::to_string(i) + "\n" + text, scene, loop);
    }
  }
}

/// In a hollow edge the proxy stands still, while beside it the smoothed surface slopes: the stored
/// energy has a fold where the proxy enters the edge, and the force jumps there.
TEST(ShadedWalls, AHollowEdgeHasAFoldOfWhatTheSmoothedSurfaceSlopesBesideIt) {
  constexpr double kStiffness = 1000.0;  // [N/m]
  constexpr double kHeld = 0.9;          // of the depth: the limit of the height
  for (const double tilt : {5.0, 15.0, 30.0, 45.0}) {
    const double angle = tilt * std::numbers::pi / 180.0;
    const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
    const Vec3 uphill(-std::cos(angle), 0.0, std::sin(angle));
    const Vec3 other(-normal.x, 0.0, normal.z);
    const ScenePtr scene = sceneOf(
        "palpate: 1\nlength: mm\nmaterials: {m: {stiffness: 1000 N/m, shading: 1 mm}}\n"
        "layers: [{name: body, inside: {union: [" +
        halfSpaceText(normal) + ", " + halfSpaceText(other) + "]}, wall: m}]\n");
    SmoothedField smoothed;
    const FeltHeight there = smoothed.at(*scene->regions()[1].field, 1e-3, Vec3(0.0));
    // The smoothed surface's gradient is the mean of the two normals.
    const double slope = std::fabs(glm::dot(there.gradient, uphill));
    EXPECT_NEAR(slope, 0.5 * std::sin(2.0 * angle), 1e-9);
    for (const double deep : {0.5e-3, 1e-3, 2e-3}) {
      Drive hand(scene);
      (void)hand.to(mm(0, 0, 10));
      (void)hand.walk(0.1e-3 * uphill - deep * normal, 0.05e-3);
      const Vec3 beside = hand.walk(1e-9 * uphill - deep * normal, 0.01e-3).force;
      const Vec3 within = hand.walk(-1e-9 * uphill - deep * normal).force;
      // The stored energy changes by the stiffness times the part of the depth at which the full
      // height counts.
      const double due = kStiffness * (deep - std::fabs(there.value) / kHeld) * slope;
      EXPECT_NEAR(glm::length(beside - within), due, 1e-4 * due) << tilt << " degrees";
      EXPECT_LE(glm::length(beside - within), slope * glm::length(within)) << tilt << " degrees";
      // Beside the edge the wall also pushes along itself, uphill; in the edge it pushes only
      // perpendicular to itself.
      EXPECT_NEAR(glm::dot(beside - within, uphill), due, 1e-4 * due) << tilt << " degrees";
    }
  }
}

}  // namespace
}  // namespace palpate::test
