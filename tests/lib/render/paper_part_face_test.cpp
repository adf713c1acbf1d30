// The paper's renderer where a port is on a part of what it has as one face: the face stays a wall.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

// A union is one face of the layer: the paper's table of states has intersections alone. The port is on the left ball.
const char* const kTwoBalls = R"(
palpate: 1
length: mm
fields:
  left: {sphere: {center: [-30, 0, 0], radius: 20}}
  right: {sphere: {center: [30, 0, 0], radius: 20}}
materials: {glass: {stiffness: 1000 N/m}}
layers:
  - {name: balls, inside: {union: [left, right]}, wall: glass}
ports:
  - {name: hole, between: [outside, balls], on: left}
)";

TEST(PaperPartFace, APortOnOneBallLeavesTheOtherAWall) {
  Drive hand(sceneOf(kTwoBalls), RendererKind::kPaper);
  (void)hand.to(mm(30, 0, 25));
  const TickResult out = hand.walk(mm(30, 0, 18));
  EXPECT_EQ(hand.region(), "outside");
  EXPECT_TRUE(out.contact);
  // The contact point is on the ball to a micrometer, and 2 mm above the hand.
  EXPECT_TRUE(isNear(out.proxy, mm(30, 0, 20), 2e-6));
  EXPECT_TRUE(isNear(out.force, Vec3(0, 0, 2.0), 2e-6 * 1000.0));
}

}  // namespace
}  // namespace palpate::test
