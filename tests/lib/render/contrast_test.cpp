// Stiffness that changes within a short distance: felt over a patch that grows with the depth, and
// reported at set-up.

#include "palpate/render/contrast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lib/render/energy_loop.h"
#include "palpate/contact/contact_patch.h"
#include "palpate/fields/primitives.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

using testing::FunctionMap;

/// 300 N/m, and from x = 0 on 3000 N/m, over `width` [m], with a continuous slope.
MaterialMapPtr step(double width) {
  return std::make_shared<FunctionMap>(
      [=](const Vec3& p) {
        const double t = std::clamp(p.x / width + 0.5, 0.0, 1.0);
        MaterialMap::Sample out{300.0 + 2700.0 * t * t * (3.0 - 2.0 * t), Vec3(0.0)};
        out.gradient.x = 2700.0 * 6.0 * t * (1.0 - t) / width;
        return out;
      },
      MaterialMap::Range{300.0, 3000.0});
}

ScenePtr sceneWith(const FieldPtr& field, const Parameter& stiffness) {
  SceneDescription description;
  Material wall;
  wall.name = "wall";
  wall.stiffness = stiffness;
  description.materials = {wall};
  LayerDescription layer;
  layer.name = "body";
  layer.inside = std::make_shared<FieldSource>(field);
  layer.wall.material = "wall";
  description.layers = {layer};
  description.meters_per_unit = 1e-3;
  return compile(description);
}

const FieldPtr kFloor = halfSpace(Vec3(0.0), Vec3(0, 0, 1));

// Ten times as stiff from one voxel to the next: read at a point, the gradient term would push
// sideways with 60 N where the wall pushes back with 15 N.
TEST(Contrasts, NeverPushSidewaysAsHardAsTheWallPushesBack) {
  for (const double width : {0.5e-3, 1e-3, 2e-3}) {
    Drive hand(sceneWith(kFloor, step(width)));
    for (const double depth : {0.2e-3, 1e-3, 3.5e-3, 7e-3, 14e-3}) {
      (void)hand.walk(Vec3(-0.02, 0.001, 0.001));
      (void)hand.walk(Vec3(-0.02, 0.001, -depth));
      double most = 0.0;
      double jump = 0.0;
      Vec3 last = hand.last().force;
      for (int i = 1; i <= 40'000; ++i) {
        const Vec3 force = hand.to(Vec3(-0.02 + 1e-6 * i, 0.001, -depth)).force;
        most = std::max(most, glm::length(Vec3(force.x, force.y, 0)) / force.z);
        jump = std::max(jump, glm::length(force - last));
        last = force;
      }
      std::printf(
          "  over %.2f mm, %4.1f mm deep: sideways over back %.3f, largest step in 1 um %.3g N\n",
          1e3 * width, 1e3 * depth, most, jump);
      // If the depth is more than fourteen times the width of a contrast, the hand feels single
      // places of the patch; the set-up reports that (below).
      if (depth <= 14.01 * width) {
        EXPECT_LT(most, 1.0) << width << " " << depth;
      }
      // Away from the contrast each side has its own stiffness.
      EXPECT_NEAR(hand.last().force.z, 3000.0 * depth, 1e-9);
    }
  }
}

TEST(Contrasts, GiveNoEnergy) {
  Random random(6);
  const ScenePtr flat = sceneWith(kFloor, step(0.5e-3));
  const ScenePtr ball = sceneWith(sphere(Vec3(0.0), 0.02), step(0.5e-3));
  for (int i = 0; i < 3; ++i) {
    EnergyLoop loop = randomLoop(random, mm(0.2, 0, -1), 0.2e-3, 1.0e-3);
    const EnergyGiven on_floor = energyGiven(flat, mm(0, 0, 10), loop);
    loop.center = mm(0.2, 0, 19);
    const EnergyGiven on_ball = energyGiven(ball, mm(0, 0, 30), loop);
    std::printf("  floor %.3g J (%.1g), ball %.3g J (%.1g)\n", on_floor.work, on_floor.change,
                on_ball.work, on_ball.change);
    EXPECT_LE(on_floor.work, 1e-9);
    EXPECT_LE(on_ball.work, 1e-9);
  }
}

TEST(Contrasts, AreToldWithWhatRemains) {
  const std::vector<Contrast> none = contrastsOf(*sceneWith(kFloor, testing::flatMap(700.0)));
  EXPECT_TRUE(none.empty());
  const std::vector<Contrast> gentle =
      contrastsOf(*sceneWith(kFloor, testing::linearMap(1000.0, {2e4, 0, 0}, {500.0, 1500.0})));
  ASSERT_EQ(gentle.size(), 1U);
  EXPECT_NEAR(gentle[0].length, 500.0 / 2e4, 2e-3);
  const std::vector<Contrast> sharp = contrastsOf(*sceneWith(kFloor, step(0.5e-3)));
  ASSERT_EQ(sharp.size(), 1U);
  EXPECT_EQ(sharp[0].material, 0);
  EXPECT_NEAR(sharp[0].at.x, 0.0, 0.25e-3);
  // The contrast is sharpest where K / K' is smallest, slightly on the soft side of the middle.
  EXPECT_LT(sharp[0].length, 0.2e-3);
  EXPECT_GT(sharp[0].length, 0.05e-3);
  EXPECT_GT(sharp[0].sideways, 0.05);
}

/// The energy [J] of a floor, averaged over the patch, with the hand at `hip` beneath it.
double energyAt(const Parameter& stiffness, const Vec3& hip, double contrast) {
  const Vec3 press(0, 0, -hip.z);
  const PatchSample felt = overPatch(stiffness, Vec3(hip.x, hip.y, 0.0), press, contrast);
  return 0.5 * felt.value * hip.z * hip.z;
}

TEST(Contrasts, TheForceIsWhatTheEnergyOverThePatchFallsBy) {
  const Parameter stiffness = step(0.5e-3);
  const ScenePtr scene = sceneWith(kFloor, stiffness);
  const double contrast = contrastsOf(*scene).at(0).length;
  constexpr double kStep = 1e-8;
  for (const Vec3& hip : {mm(0, 0, -0.5), mm(0.3, 0.2, -1), mm(-0.8, 0, -2), mm(0.2, 0.1, -3)}) {
    Drive hand(scene);
    (void)hand.to(Vec3(hip.x, hip.y, 1e-3));
    const Vec3 force = hand.walk(hip).force;
    const Vec3 expected =
        fallOf([&](const Vec3& p) { return energyAt(stiffness, p, contrast); }, hip, kStep);
    for (int axis = 0; axis < 3; ++axis) {
      // The energy is about a millijoule, rounded at 1e-13 J at most; divided by the step that is
      // 1e-8 N. The position of the wall is exact to 1e-9 m.
      EXPECT_NEAR(force[axis], expected[axis], 1e-5) << axis << " " << hip.z;
    }
  }
}

TEST(Contrasts, ASharpStepIsFoundBesideALargerGentleOne) {
  // Within a ball of 50 mm the logarithm of the stiffness rises evenly by 9, and by a further 0.1
  // within 0.2 mm, where it is steepest.
  constexpr double kHalf = 0.05;
  constexpr double kGentle = 9.0 / (2.0 * kHalf);  // [1/m]
  constexpr double kWidth = 0.2e-3;
  constexpr double kAt = 0.02;
  const auto map = std::make_shared<FunctionMap>(
      [](const Vec3& p) {
        MaterialMap::Sample out{1.0, Vec3(0.0)};
        // Outside the ball's bounds there is nothing to find.
        if (std::max(std::fabs(p.y), std::fabs(p.z)) > 1.001 * kHalf) return out;
        const double t = std::clamp((p.x - kAt) / kWidth + 0.5, 0.0, 1.0);
        out.value = std::exp(kGentle * (p.x + kHalf) + 0.1 * t * t * (3.0 - 2.0 * t));
        out.gradient.x = out.value * (kGentle + 0.1 * 6.0 * t * (1.0 - t) / kWidth);
        return out;
      },
      MaterialMap::Range{0.5, 2e4});
  const std::vector<Contrast> found =
      contrastsOf(*sceneWith(sphere(Vec3(0.0), kHalf), MaterialMapPtr(map)));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].at.x, kAt, kWidth);
  // The contrast must be found in the middle of the step; a secant is nowhere steeper, and over
  // half of the step at least half as steep.
  const double steepest = kGentle + 0.1 * 1.5 / kWidth;
  EXPECT_GE(found[0].length, (1.0 - 1e-6) / steepest);
  EXPECT_LE(found[0].length, 2.0 / steepest);
}

}  // namespace
}  // namespace palpate::test
