// Friction, damping and relaxation where several walls hold the proxy, or one hands it on to the
// next.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// Two layers of the shapes `a` and `b`, with the materials of their walls.
std::string twoLayers(const std::string& a, const std::string& left, const std::string& b,
                      const std::string& right) {
  return "palpate: 1\nlength: mm\nmaterials:\n  left: {" + left + "}\n  right: {" + right +
         "}\nlayers:\n  - {name: a, inside: {" + a + "}, wall: left}\n  - {name: b, inside: {" + b +
         "}, wall: right}\n";
}

/// A right angle that opens upwards.
std::string groove(const std::string& left, const std::string& right) {
  return twoLayers("half_space: {point: [0, 0, 0], normal: [1, 0, 1]}", left,
                   "half_space: {point: [0, 0, 0], normal: [-1, 0, 1]}", right);
}

TEST(SeveralWalls, TheRoughestHoldsForTheLoadOfAll) {
  for (const bool swapped : {false, true}) {
    const std::string rough = "stiffness: 1000 N/m, friction: {static: 0.5, kinetic: 0.4}";
    const std::string smooth = "stiffness: 1000 N/m, friction: {static: 0.2, kinetic: 0.1}";
    Drive hand(sceneOf(swapped ? groove(smooth, rough) : groove(rough, smooth)));
    (void)hand.to(mm(0, 0, 5));
    (void)hand.walk(mm(0, 0, -2));
    TickResult out;
    for (int i = 1; i <= 4000; ++i) out = hand.to(mm(0, 2e-3 * i, -2));
    // Straight down, the load is that of one wall pressed 2 mm deep.
    EXPECT_NEAR(out.force.z, 2.0, 1e-6);
    EXPECT_NEAR(-out.force.y, 0.4 * 2.0, 1e-5);
  }
}

TEST(SeveralWalls, DampingIsTheMeanByHowHardEachIsPressed) {
  Drive hand(sceneOf(
      groove("stiffness: 1000 N/m, damping: 3 N.s/m", "stiffness: 1000 N/m, damping: 9 N.s/m")));
  (void)hand.to(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -2));
  const auto damping_at = [&](const Vec3& p) {
    (void)hand.walk(p);
    return -hand.renderer().update({p, Vec3(0, 0.1, 0)}).force.y / 0.1;
  };
  EXPECT_NEAR(damping_at(mm(0, 0, -2)), 6.0, 1e-6);
  // The left wall is pressed three times as hard as the right one: their depths are 1.5 and 0.5
  // over sqrt 2.
  EXPECT_NEAR(damping_at(mm(-0.5, 0, -1)), (3.0 * 0.75 + 9.0 * 0.25), 1e-6);
  // The damping is never the sum of both.
  EXPECT_LE(damping_at(mm(0.3, 0, -1)), 9.0);
}

std::string blocks(const std::string& left, const std::string& right) {
  return twoLayers("box: {center: [-10, 0, -5], size: [20, 20, 10]}", left,
                   "box: {center: [10, 0, -5], size: [20, 20, 10]}", right);
}

TEST(SeveralWalls, WhatRelaxesAlikeIsHandedOn) {
  const std::string soft = "stiffness: 1000 N/m, maxwell: {stiffness: 3000 N/m, time: 500 ms}";
  for (const char* other : {"", ", damping: 1e-9 N.s/m"}) {
    Drive hand(sceneOf(blocks(soft, soft + other)));
    (void)hand.to(mm(-1, 0, 1));
    (void)hand.walk(mm(-1, 0, -3));
    double last = hand.last().force.z;
    EXPECT_GT(last, 9.0);
    double largest = 0.0;
    for (int i = 1; i <= 400; ++i) {
      const double now = hand.to(mm(-1 + 5e-3 * i, 0, -3)).force.z;
      largest = std::max(largest, last - now);
      last = now;
    }
    // A tick of 1 ms relaxes 0.2 % of the branch's force.
    EXPECT_LT(largest, 0.03) << other;
  }
  // A branch with other parameters begins relaxed, so that no energy appears.
  Drive hand(
      sceneOf(blocks(soft, "stiffness: 1000 N/m, maxwell: {stiffness: 9000 N/m, time: 500 ms}")));
  (void)hand.to(mm(-1, 0, 1));
  (void)hand.walk(mm(-1, 0, -3));
  (void)hand.walk(mm(1, 0, -3));
  EXPECT_NEAR(hand.last().force.z, 3.0, 1e-6);
}

}  // namespace
}  // namespace palpate::test
