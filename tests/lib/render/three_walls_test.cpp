// Three curved walls at a point: a hand pressed into their corner is held there by one steady
// force.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/rest_oracle.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.05e-3;  // [m] way of the hand in a tick

/// Observations of a hand that is pressed to `goal` and held there, where `corner` is the point
/// that holds it.
struct Held {
  double worst_proxy = 0.0;  ///< [m] distance from the corner, at rest
  double worst_force = 0.0;  ///< [N] difference from K (corner - P), at rest
  double largest_step =
      0.0;  ///< [N] largest change between ticks on the way in, beyond that due to the hand's way
  int without_contact = 0;
};

Held press(Drive& drive, const Vec3& from, const Vec3& goal, const Vec3& corner, int held_ticks) {
  Held out;
  Vec3 last_force = drive.to(from).force;
  const double way = glm::length(goal - from);
  for (double at = kTick; at < way + kTick; at += kTick) {
    const TickResult& now = drive.to(from + std::min(1.0, at / way) * (goal - from));
    out.largest_step = std::max(out.largest_step, glm::length(now.force - last_force));
    last_force = now.force;
  }
  const Vec3 right = kDefaultK * (corner - goal);
  for (int i = 0; i < held_ticks; ++i) {
    const TickResult& now = drive.to(goal);
    if (i < 5) continue;  // the rest of the way may take a few ticks
    out.worst_proxy = std::max(out.worst_proxy, glm::length(now.proxy - corner));
    out.worst_force = std::max(out.worst_force, glm::length(now.force - right));
    out.without_contact += now.contact ? 0 : 1;
  }
  return out;
}

/// Expects that at rest the proxy is right to 1e-6 of the depth, and the force to 1e-6 of K times
/// the depth.
void expectSteady(const Held& held, double depth) {
  EXPECT_LE(held.worst_proxy, 1e-6 * depth);
  EXPECT_LE(held.worst_force, 1e-6 * kDefaultK * depth);
  EXPECT_EQ(held.without_contact, 0);
}

/// Presses that did not end correctly.
struct Tally {
  int pressed = 0;
  int wrong =
      0;  ///< not at rest after 30 ticks, or its force is not K (x - P), or it reports no contact
  int unsteady = 0;  ///< the force changes by 1 mN in the next 30
  int first = 0;     ///< index of the first wrong one

  void expectNone() const {
    EXPECT_EQ(wrong, 0) << "of " << pressed << ", the first: " << first;
    EXPECT_EQ(unsteady, 0) << "of " << pressed;
  }
};

/// The hand goes straight to `goal` and stays. The proxy may have come to rest elsewhere than
/// intended; wherever that is, an oracle confirms that it rests.
void pressAndJudge(const ScenePtr& scene, const testing::RegionTree& tree, const Vec3& from,
                   const Vec3& goal, Tally& tally) {
  const testing::RestOracle oracle(tree);
  ++tally.pressed;
  Drive drive(scene);
  (void)drive.to(from);
  (void)drive.walk(goal, kTick);
  for (int i = 0; i < 30; ++i) (void)drive.to(goal);
  const TickResult rest = drive.last();
  const double depth = glm::length(rest.proxy - goal);
  const double off = glm::length(rest.force - kDefaultK * (rest.proxy - goal));
  const bool is_right = oracle.check(rest.proxy, goal).residual <= 1e-7 * depth && rest.contact &&
                        off <= 1e-6 * kDefaultK * depth;
  bool is_steady = true;
  for (int i = 0; i < 30; ++i) {
    is_steady &= glm::length(drive.to(goal).force - rest.force) <= 1e-3;
  }
  tally.unsteady += is_steady ? 0 : 1;
  if (!is_right && tally.wrong++ == 0) tally.first = tally.pressed;
}

/// The point above the xy plane that three spheres have in common.
const Vec3& ballsCorner() {
  static const Vec3 corner = [] {
    const double x = (400.0 - 225.0 + 400.0) / 40.0;
    const double y = (400.0 - 144.0 + 424.0 - 20.0 * x) / 36.0;
    return mm(x, y, std::sqrt(400.0 - x * x - y * y));
  }();
  return corner;
}

/// A direction away from everything permitted at that corner, with a weight for each wall.
Vec3 intoBallsCorner(double first, double second, double third) {
  const Vec3& c = ballsCorner();
  return glm::normalize(first * c / 0.020 - second * (c - mm(20, 0, 0)) / 0.015 -
                        third * (c - mm(10, 18, 0)) / 0.012);
}

TEST(ThreeWalls, ThreeBallsAsLayersOfOneWall) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials: {wall: {stiffness: 1000 N/m}}
layers:
  - {name: first, inside: {sphere: {center: [0, 0, 0], radius: 20}}, wall: wall}
  - {name: second, inside: {sphere: {center: [20, 0, 0], radius: 15}}, wall: wall}
  - {name: third, inside: {sphere: {center: [10, 18, 0], radius: 12}}, wall: wall}
start: {region: first}
)");
  // Straight from the first ball's middle, so that the other two walls exert no force; and tilted
  // towards each of them.
  for (const Vec3& weights :
       {Vec3(1, 0, 0), Vec3(1, 0.02, 0.02), Vec3(1, 0.3, 0.1), Vec3(1, 0.1, 0.3), Vec3(1, 1, 1)}) {
    SCOPED_TRACE(::testing::Message() << "weights " << Judge::text(weights));
    const Vec3 into = intoBallsCorner(weights.x, weights.y, weights.z);
    for (const double before : {20.0, 5.0, 1.0}) {
      const Vec3 from = ballsCorner() - 1e-3 * before * into;
      if (scene->regionAt(from) != scene->startRegion()) continue;
      Drive drive(scene);
      expectSteady(press(drive, from, ballsCorner() + 0.004 * into, ballsCorner(), 200), 0.004);
    }
  }
}

TEST(ThreeWalls, ThreeBallsAreMetFromAllSides) {
  // Not straight into the corner: along one or two walls, so that the proxy slides to the third
  // one.
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials: {wall: {stiffness: 1000 N/m}}
layers:
  - {name: first, inside: {sphere: {center: [0, 0, 0], radius: 20}}, wall: wall}
  - {name: second, inside: {sphere: {center: [20, 0, 0], radius: 15}}, wall: wall}
  - {name: third, inside: {sphere: {center: [10, 18, 0], radius: 12}}, wall: wall}
start: {region: first}
)");
  const testing::RegionTree tree(*scene, scene->startRegion());
  Random random(61);
  Tally tally;
  while (tally.pressed < 400) {
    const Vec3 from = ballsCorner() + 0.004 * random.direction();
    if (tree.value(from) < 0.1e-3) continue;
    const Vec3 into =
        intoBallsCorner(random.uniform(0.05, 1), random.uniform(0.05, 1), random.uniform(0.05, 1));
    pressAndJudge(scene, tree, from, ballsCorner() + 0.004 * into, tally);
  }
  tally.expectNone();
}

TEST(ThreeWalls, ABallMinusTwoBallsWithTheHandDeadStill) {
  const FieldPtr solid = subtract(
      {sphere(Vec3(0.0), 0.020), sphere(mm(20, 0, 0), 0.015), sphere(mm(10, 18, 0), 0.012)});
  const Vec3 into = intoBallsCorner(1.0, 1.0, 1.0);
  Drive drive(sceneOfSolid(solid, true));
  const Held held =
      press(drive, ballsCorner() - 0.002 * into, ballsCorner() + 0.003 * into, ballsCorner(), 400);
  expectSteady(held, 0.003);
  EXPECT_NEAR(glm::length(drive.last().force), 3.0, 3e-6);
}

/// Three balls through the origin, each felt from inside (its center is on the permitted side) or
/// from outside.
struct Corner {
  FieldPtr solid;               ///< the solid that the hand is in
  std::array<Vec3, 3> normals;  ///< [-] towards the permitted side
};

Corner randomCorner(Random& random, int hollow) {
  Corner out;
  do {
    for (Vec3& n : out.normals) n = random.direction();
  } while (std::fabs(glm::dot(out.normals[0], glm::cross(out.normals[1], out.normals[2]))) < 0.1);
  std::vector<FieldPtr> parts;
  for (int i = 0; i < 3; ++i) {
    const double radius = random.uniform(0.005, 0.05);
    const Vec3 n = out.normals[static_cast<std::size_t>(i)];
    parts.push_back(i < hollow ? sphere(radius * n, radius)
                               : complement(sphere(-radius * n, radius)));
  }
  // The solid is inside a larger ball, so that it has bounds.
  parts.push_back(sphere(Vec3(0.0), 0.2));
  out.solid = intersect(parts);
  return out;
}

class ThreeWallsCorners : public ::testing::TestWithParam<int> {};

TEST_P(ThreeWallsCorners, HoldAHandWithinTheConeOfTheirNormals) {
  Random random(static_cast<std::uint64_t>(40 + GetParam()));
  Tally tally;
  while (tally.pressed < 400) {
    const Corner corner = randomCorner(random, GetParam());
    const Mat3 normals(corner.normals[0], corner.normals[1], corner.normals[2]);
    const Vec3 free = 0.004 * random.direction();
    if (corner.solid->value(free) > -0.1e-3) continue;
    const Vec3 weights(random.uniform(0.02, 1), random.uniform(0.02, 1), random.uniform(0.02, 1));
    const Vec3 goal = -0.003 * glm::normalize(normals * weights);
    const ScenePtr scene = sceneOfSolid(corner.solid, true);
    const testing::RegionTree tree(*scene, scene->startRegion());
    pressAndJudge(scene, tree, free, goal, tally);
  }
  tally.expectNone();
}

INSTANTIATE_TEST_SUITE_P(Hollow, ThreeWallsCorners, ::testing::Values(0, 1, 2, 3),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace palpate::test
