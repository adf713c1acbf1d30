// A needle's shaft pushed sideways, felt at the tip; the cut of a tip that rests on bone; and the
// energy of both.

#include <gtest/gtest.h>

#include <cmath>

#include "lib/render/drive.h"
#include "support/energy_meter.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Tissue that holds the shaft sideways, without cutting or friction.
std::string tissue(const std::string& lateral, const std::string& more = {}) {
  return "{stiffness: 300 N/m" + more +
         ", shaft: {stiffness: 1e5 N/m^2, in: {static: 0 N/m}, lateral: " + lateral + "}}";
}

/// Layers of 10 mm each, the last one without end, in the order of `materials`, with open walls
/// between.
ScenePtr stack(const std::vector<std::string>& materials, const std::string& more = {}) {
  std::string text = "palpate: 1\nlength: mm\nmaterials:\n";
  std::string layers = "layers:\n";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string n = std::to_string(i);
    text += "  m" + n + ": " + materials[i] + "\n";
    layers += "  - {name: l" + n + ", content: m" + n + ", wall: m" + n +
              ", inside: {half_space: {point: [0, 0, " + std::to_string(-10 * static_cast<int>(i)) +
              "], normal: [0, 0, 1]}}}\n";
  }
  return sceneOf(text + layers + more + "ports: [{name: all, between: [\"*\", \"*\"]}]\n");
}

// 25 mm deep and 3 mm sideways with 36 kN/m^2: K L u / 3 = 0.9 N, where an earlier version had 0.
TEST(NeedleShaft, SidewaysItPushesBackByItsClosedForm) {
  Drive hand(stack({tissue("{stiffness: 3.6e4 N/m^2}")}));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -25), 50e-6);
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  // On an arc about the hole the length of the shaft inside is constant: exact.
  const double reach = 0.025;
  const double last = std::asin(3.0 / 25.0);
  for (int i = 1; i <= 60; ++i) {
    const double angle = last * i / 60.0;
    const Vec3 needle(std::sin(angle), 0.0, -std::cos(angle));
    (void)hand.to(reach * needle);
    const Vec3 back(-std::cos(angle), 0.0, -std::sin(angle));
    ASSERT_TRUE(
        isNear(hand.last().force, 3.6e4 * reach * reach * std::sin(angle) / 3.0 * back, 1e-7));
  }
  EXPECT_NEAR(glm::length(hand.last().force), 0.9, 1e-6);
  // Back to where it was cut: no force is left.
  for (int i = 59; i >= 0; --i) {
    const double angle = last * i / 60.0;
    (void)hand.to(reach * Vec3(std::sin(angle), 0.0, -std::cos(angle)));
  }
  EXPECT_LT(glm::length(hand.last().force), 1e-9);
}

// Moving straight sideways at the same depth, a further 0.18 mm of shaft comes in on the way, at
// the needle's direction then.
TEST(NeedleShaft, StraightSidewaysItIsWithinTwoPercentOfTheClosedForm) {
  for (const bool cuts : {false, true}) {
    Drive hand(stack({tissue("{stiffness: 3.6e4 N/m^2}", cuts ? ", cutting: 0.4 N" : "")}));
    (void)hand.walk(mm(0, 0, 5));
    (void)hand.walk(mm(0, 0, -25), 50e-6);
    (void)hand.walk(mm(3, 0, -25), 50e-6);
    const Vec3 force = hand.last().force;
    // The cutting force of the tip is added: the 0.4 N that were the only force before.
    EXPECT_NEAR(-force.x, 0.9 + (cuts ? 0.4 : 0.0), 0.02 * 0.9 + (cuts ? 0.03 : 0.0));
    EXPECT_LT(std::fabs(force.y), 1e-12);
  }
}

TEST(NeedleShaft, EachTissueHoldsThePartThatIsInIt) {
  // Three layers of 10 mm, the middle one free; the tip is 7 mm below the top of the last one.
  Drive hand(stack({tissue("{stiffness: 2e4 N/m^2}"), "{stiffness: 300 N/m}",
                    tissue("{stiffness: 5e4 N/m^2}")}));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -27), 50e-6);
  const double angle = 0.05;
  (void)hand.to(0.027 * Vec3(0.0, std::sin(angle), -std::cos(angle)));
  const auto cubes = [](double a, double b) { return (b * b * b - a * a * a) / 3.0; };
  const double expected =
      (2e4 * cubes(0.0, 0.010) + 5e4 * cubes(0.020, 0.027)) * std::sin(angle) / 0.027;
  EXPECT_NEAR(glm::length(hand.last().force), expected, 1e-6);
  EXPECT_LT(hand.last().force.y, 0.0);
}

TEST(NeedleShaft, ThroughTheFarSideAllOfItStillHolds) {
  Drive hand(
      sceneOf("palpate: 1\nlength: mm\nmaterials: {m: " + tissue("{stiffness: 3e4 N/m^2}") +
              "}\nlayers: [{name: a, inside: {box: {center: [0, 0, -10], size: [90, 90, 20]}}, "
              "content: m, wall: m}]\nports: [{name: p, between: [outside, a]}]\n"));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -40), 50e-6);
  ASSERT_EQ(hand.region(), "outside");
  const double angle = 0.06;
  (void)hand.to(0.040 * Vec3(std::sin(angle), 0.0, -std::cos(angle)));
  // 20 mm of shaft in the tissue, felt at 40 mm: a lever.
  const double expected = 3e4 * std::pow(0.02, 3) / 3.0 * std::sin(angle) / 0.04;
  EXPECT_NEAR(glm::length(hand.last().force), expected, 1e-6);
}

TEST(NeedleShaft, ItTearsAtItsStrengthAndIsBounded) {
  Drive hand(stack({tissue("{stiffness: 3.6e4 N/m^2, strength: 40 N/m}")}));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -25), 50e-6);
  double most = 0.0;
  for (int i = 1; i <= 400; ++i) {
    const double angle = 1e-3 * i;
    (void)hand.to(0.025 * Vec3(std::sin(angle), 0.0, -std::cos(angle)));
    most = std::max(most, glm::length(hand.last().force));
  }
  // The load grows linearly along the shaft, so its resultant acts at two thirds of the length: the
  // tip feels 2/3 strength L.
  EXPECT_NEAR(most, 2.0 / 3.0 * 40.0 * 0.025, 0.005);
  EXPECT_NEAR(glm::length(hand.last().force), most, 0.005);
}

TEST(NeedleShaft, DrawnOutAndInAgainTheChannelIsNew) {
  Drive hand(stack({tissue("{stiffness: 3.6e4 N/m^2}")}));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -25), 50e-6);
  (void)hand.walk(mm(3, 0, -25), 50e-6);
  (void)hand.walk(mm(0, 0, 5), 50e-6);
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  (void)hand.walk(mm(3, 0, 5), 50e-6);
  (void)hand.walk(mm(3, 0, -25), 50e-6);
  EXPECT_LT(glm::length(hand.last().force), 1e-9);
}

// The tip is on a wall that closes the tissue: the sideways energy depends on the place of the tip,
// which the hand moves only along the wall. On any closed path nothing is gained.
TEST(NeedleShaft, NoLoopGivesEnergyFreeOrOnAWall) {
  const ScenePtr scene =
      sceneOf("palpate: 1\nlength: mm\nmaterials: {m: " + tissue("{stiffness: 3.6e4 N/m^2}") +
              ", bone: {stiffness: 2000 N/m}}\n"
              "layers: [{name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, "
              "content: m, wall: m}, "
              "{name: bone, inside: {sphere: {center: [0, 0, -40], radius: 20}}, wall: bone}]\n"
              "ports: [{name: p, between: [outside, a]}]\n");
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    Drive hand(scene);
    (void)hand.walk(mm(0, 0, 5));
    (void)hand.walk(mm(0, 0, -18), 50e-6);
    const Vec3 home = hand.hip();
    const double energy_at_rest = 0.0;
    Vec3 p = home;
    Vec3 way(0.0);
    Vec3 force = hand.last().force;
    double work = energy_at_rest;
    double moved = 0.0;
    int pressed = 0;
    for (int i = 0; i < 20'000; ++i) {
      // Every other time around a place 3 mm inside the bone.
      const Vec3 middle = mm(0, 0, seed % 2 == 0 ? -23 : -16);
      way += 3e-6 * random.direction() - 2e-5 * (p - middle) - 0.01 * way;
      const Vec3 last = p;
      p += way;
      (void)hand.to(p);
      const double gave = 0.5 * glm::dot(force + hand.last().force, p - last);
      work += gave;
      moved += std::fabs(gave);
      force = hand.last().force;
      pressed += hand.last().contact ? 1 : 0;
      ASSERT_LE(work, 2e-5 * moved + 1e-9) << seed << ", " << i;
    }
    EXPECT_GT(moved, 1e-3);
    if (seed % 2 == 0) {
      EXPECT_GT(pressed, 2000);
    }
  }
}

std::string overBone(const std::string& muscle) {
  return "palpate: 1\nlength: mm\nmaterials: {m: {" + muscle +
         "}, bone: {stiffness: 3000 N/m}}\n"
         "layers: [{name: muscle, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, "
         "content: m, wall: m}, "
         "{name: bone, inside: {half_space: {point: [0, 0, -20], normal: [0, 0, 1]}}, wall: "
         "bone}]\n"
         "ports: [{name: p, between: [outside, muscle]}]\n";
}

// Muscle's cutting force of 0.6 N does not add to a press on the bone behind it, whether light or
// heavy.
TEST(NeedleOnBone, NothingIsCutWhereTheTipRestsOnIt) {
  Drive hand(sceneOf(overBone("stiffness: 150 N/m, cutting: 0.6 N")));
  (void)hand.walk(mm(0, 0, 5));
  double worst = 0.0;
  int pressed = 0;
  for (double z = 5e-3; z > -22e-3; z -= 50e-6) {
    (void)hand.to(Vec3(0.0, 0.0, z));
    if (z > -20.001e-3) continue;
    worst = std::max(worst, std::fabs(hand.last().force.z - 3000.0 * (-20e-3 - z)));
    ++pressed;
  }
  EXPECT_GE(pressed, 39);
  EXPECT_LT(worst, 1e-5);
  // Everything before the bone is cut: the tip comes off freely, and is stopped by the bone again.
  (void)hand.walk(mm(0, 0, -19.9), 50e-6);
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  (void)hand.walk(mm(0, 0, -20.5), 50e-6);
  EXPECT_NEAR(hand.last().force.z, 1.5, 1e-5);
}

TEST(NeedleOnBone, AlongItTheTissueIsCutAsEver) {
  Drive hand(sceneOf(overBone("stiffness: 150 N/m, cutting: 0.6 N")));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -21), 50e-6);
  EXPECT_TRUE(isNear(hand.last().force, Vec3(0.0, 0.0, 3.0), 1e-5));
  (void)hand.walk(mm(2, 0, -21), 50e-6);
  EXPECT_TRUE(isNear(hand.last().force, Vec3(-0.3, 0.0, 3.0), 1e-5));
  (void)hand.walk(mm(9, 0, -21), 50e-6);
  EXPECT_TRUE(isNear(hand.last().force, Vec3(-0.6, 0.0, 3.0), 1e-5));
}

// A wall that force can open can be pierced: the tissue in front of it is still pressed.
TEST(NeedleOnBone, BeforeAWallThatCanBePiercedItIsPressedOn) {
  std::string text = overBone("stiffness: 150 N/m, cutting: 0.6 N");
  text.replace(text.find("ports: ["), 8,
               "ports: [{name: q, between: [muscle, bone], opens_at: 50 N}, ");
  Drive hand(sceneOf(text));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -21), 50e-6);
  EXPECT_TRUE(isNear(hand.last().force, Vec3(0.0, 0.0, 3.6), 1e-5));
}

}  // namespace
}  // namespace palpate::test
