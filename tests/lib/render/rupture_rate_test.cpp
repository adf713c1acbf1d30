// Walls whose rupture force depends on the speed of the press.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

constexpr double kStiffness = 1000.0;  // [N/m]

std::string skin(const std::string& rate) {
  return R"(
palpate: 1
length: mm
materials: {skin: {stiffness: 1000 N/m}}
layers: [{name: flesh, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}]
ports: [{name: cut, between: [outside, flesh], opens_at: 2 N, back: 1 N, hole: {radius: 1, reopens_at: 0.5 N})" +
         rate + "}]\n";
}

/// [N] at which the wall ruptures under a hand that moves along z at `speed` [m/s], from `from` to
/// `to` [m].
double ruptureOf(HapticRenderer& renderer, double x, double from, double to, double speed) {
  const double dt = 1e-6 / speed;  // a micrometer in a tick: the force is off by at most 1 mN
  const double way = to > from ? 1.0 : -1.0;
  for (double z = from; way * z < way * to; z += way * 1e-6) {
    const TickResult r = renderer.update({Vec3(x, 0.0, z), Vec3(0.0, 0.0, way * speed), dt});
    if (r.event_count > 0) return renderer.crossings().front().force;
  }
  return -1.0;
}

struct Rate {
  const char* text;
  double ratio, speed;
};

TEST(RuptureRate, FollowsItsCurveBothWays) {
  for (const Rate& rate :
       {Rate{"", 1.0, 0.0}, Rate{", rate: {ratio: 0.4, speed: 20 mm/s}", 0.4, 0.02},
        Rate{", rate: {ratio: 2.5, speed: 50 mm/s}", 2.5, 0.05}}) {
    const auto renderer = makeRenderer(sceneOf(skin(rate.text)));
    double x = 0.0;
    for (const double speed : {0.001, 0.02, 0.1, 1.0}) {
      const double share = 1.0 + (rate.ratio - 1.0) * speed / (speed + rate.speed);
      x += 0.01;  // where there is no hole yet
      renderer->reset();
      EXPECT_NEAR(ruptureOf(*renderer, x, 1e-4, -0.01, speed), share * 2.0, kStiffness * 1.1e-6)
          << rate.text << " at " << speed;
      // In the hole just made the speed does not matter, since nothing is torn.
      (void)renderer->update({Vec3(x, 0.0, -1e-4)});
      EXPECT_NEAR(ruptureOf(*renderer, x, -1e-4, 0.01, speed), 0.5, kStiffness * 1.1e-6);
      // Beside the hole the wall must be torn on the way back too.
      (void)renderer->update({Vec3(x, 0.0, 1e-4)});
      EXPECT_NEAR(ruptureOf(*renderer, x, 1e-4, -0.01, speed), 0.5, kStiffness * 1.1e-6);
      (void)renderer->update({Vec3(x, 0.0, -1e-4)});
      (void)renderer->update({Vec3(x + 0.003, 0.0, -1e-4)});
      EXPECT_NEAR(ruptureOf(*renderer, x + 0.003, -1e-4, 0.01, speed), share * 1.0,
                  kStiffness * 1.1e-6);
    }
  }
}

// Only the present speed into the wall counts: a hand that moves fast along it, or that has
// stopped, does not change the rupture force.
TEST(RuptureRate, IsOfTheSpeedIntoTheWall) {
  const auto renderer = makeRenderer(sceneOf(skin(", rate: {ratio: 0.4, speed: 20 mm/s}")));
  const auto press = [&](const Vec3& velocity) {
    renderer->reset();
    (void)renderer->update({Vec3(0.0, 0.0, 1e-3)});
    // 1.5 N: less than the 2 N at rest, more than the 0.8 N of a fast hand.
    return renderer->update({Vec3(0.0, 0.0, -1.5e-3), velocity}).event_count;
  };
  EXPECT_EQ(press(Vec3(0.0)), 0);
  EXPECT_EQ(press(Vec3(1.0, 1.0, 0.0)), 0);
  EXPECT_EQ(press(Vec3(0.0, 0.0, 1.0)), 0);
  EXPECT_EQ(press(Vec3(1.0, 1.0, -1.0)), 1);
}

}  // namespace
}  // namespace palpate::test
