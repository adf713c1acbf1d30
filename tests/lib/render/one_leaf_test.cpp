// Solids that are one leaf but have several sheets, as meshes, grids and implicit shapes have. The
// wall that holds the proxy is also the wall that stands in its way.

#include <gtest/gtest.h>

#include "lib/render/opaque.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

TEST(OneLeaf, SlidingOnAFloorDoesNotPassTheThinWallThatStandsOnIt) {
  // A floor 100 mm wide and a wall of 1 mm across it, 60 mm high.
  const auto floor =
      unite({box(mm(0, 0, -10), mm(200, 200, 20)), box(mm(0, 0, 25), mm(1, 200, 70))});
  for (const double step : {0.1e-3, 0.4e-3, 1e-3, 3e-3, 10e-3, 40e-3}) {
    for (const double depth : {0.2e-3, 2e-3, 10e-3}) {
      Drive drive(sceneOfLeaf(floor, 1e-3));
      (void)drive.walk(mm(-50, 0, 5), 1e-3);
      (void)drive.walk(Vec3(-0.05, 0, -depth), 1e-3);
      for (double x = -0.05; x < 0.05; x += step) {
        const TickResult& out = drive.to(Vec3(x, 0, -depth));
        ASSERT_LE(out.proxy.x, -0.5e-3 + 1e-9)
            << "step " << step << " depth " << depth << " x " << x;
        ASSERT_GE(out.proxy.z, -1e-9);
      }
    }
  }
}

TEST(OneLeaf, AHollowRoomHoldsItsCorners) {
  // The inside of a box as one leaf: its gradient shows one face at a time.
  const auto room = complement(box(Vec3(0.0), mm(60, 60, 60)));
  Drive drive(sceneOfLeaf(room, 60e-3));
  (void)drive.to(Vec3(0.0));
  for (int i = 0; i <= 4000; ++i) {
    const double t = 0.01 * i;
    const Vec3 p = 0.034 * Vec3(std::sin(t), std::sin(1.3 * t), std::sin(0.7 * t));
    const TickResult& out = drive.to(p);
    ASSERT_TRUE(isFinite(out.force));
    for (int axis = 0; axis < 3; ++axis) ASSERT_LE(std::fabs(out.proxy[axis]), 0.03 + 1e-7) << i;
  }
}

TEST(OneLeaf, TwoBallsAndTheCreaseBetweenThem) {
  const auto balls = unite({sphere(mm(-15, 0, 0), 0.025), sphere(mm(15, 0, 0), 0.025)});
  Drive drive(sceneOfLeaf(balls, 0.025));
  (void)drive.to(mm(-15, 40, 0));
  (void)drive.walk(mm(-15, 22, 0));
  // The hand goes along the top, 3 mm deep, over the crease: the proxy is always outside both
  // balls, and the wall is pressed.
  for (double x = -15.0; x <= 15.0; x += 0.25) {
    const TickResult& out = drive.to(mm(x, 17, 0));
    ASSERT_GE(balls->value(out.proxy), -1e-8) << x;
    ASSERT_GE(out.force.y, 0.0) << x;
  }
  EXPECT_TRUE(isNear(drive.walk(mm(15, 22, 0)).force, Vec3(0, 3, 0), 1e-6));
}

}  // namespace
}  // namespace palpate::test
