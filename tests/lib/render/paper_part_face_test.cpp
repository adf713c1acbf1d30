// The paper's renderer with a port on a part of what it treats as one face: the face stays a wall.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "render/paper_faces.h"

namespace palpate::test {
namespace {

// A union is one face of the layer, since the paper's table of states has only intersections. The
// port is on the left ball.
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

TEST(PaperPartFace, TheLargestOfSeveralDistancesIsABoundAndOneFaceIsAsItWas) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.02);
  const FieldPtr cut = intersect({ball, halfSpace(Vec3(0.0), Vec3(0, 0, 1))});
  const std::vector<FieldPtr> layers{ball, cut};
  const Partition partition(layers);
  EXPECT_EQ(PaperWall(ball, partition).metric(), Metric::kExact);
  PaperWall wall(cut, partition);
  ASSERT_EQ(wall.faces().size(), 2U);
  EXPECT_EQ(wall.metric(), Metric::kBound);
  // The closest point is on the rim, farther away (22 mm) than either face.
  EXPECT_NEAR(wall.value(mm(30, 0, 20)), 0.02, 1e-12);
}

}  // namespace
}  // namespace palpate::test
