// A cut against its closed form along a straight way in, out and in again, and its energy on any
// way.

#include "palpate/contact/cut.h"

#include <gtest/gtest.h>

#include <random>

namespace palpate::test {
namespace {

constexpr double kStiffness = 300.0;  // [N/m]
constexpr double kCutting = 0.6;      // [N]
constexpr double kLag = kCutting / kStiffness;

const Vec3 kEntry(0.01, -0.02, 0.03);
const Vec3 kIn = glm::normalize(Vec3(1.0, 2.0, -2.0));

TEST(Cut, IsASpringThenPlastic) {
  Cut cut(kEntry);
  for (int i = 0; i <= 300; ++i) {
    const double depth = 1e-4 * i;
    const Vec3 force = cut.step(kEntry + depth * kIn, kStiffness, kCutting);
    EXPECT_NEAR(glm::dot(force, kIn), -std::min(kStiffness * depth, kCutting), 1e-12);
    EXPECT_NEAR(glm::length(glm::cross(force, kIn)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(cut.end(), kEntry), std::max(0.0, depth - kLag), 1e-15);
  }
}

TEST(Cut, WithdrawingSlackensAndComingBackIsFreeUpToTheEnd) {
  Cut cut(kEntry);
  const auto at = [&](double depth) {
    return -glm::dot(cut.step(kEntry + depth * kIn, kStiffness, kCutting), kIn);
  };
  for (int i = 0; i <= 200; ++i) (void)at(1e-4 * i);
  const double end = 0.02 - kLag;
  EXPECT_NEAR(at(0.02), kCutting, 1e-12);
  EXPECT_NEAR(at(0.02 - 0.5 * kLag), 0.5 * kCutting, 1e-12);
  for (int i = 0; i <= 100; ++i) {
    EXPECT_NEAR(at(end * (1.0 - 0.01 * i)), 0.0, 1e-12) << "drawn back";
  }
  for (int i = 0; i <= 100; ++i) EXPECT_NEAR(at(end * 0.01 * i), 0.0, 1e-12) << "in again";
  EXPECT_NEAR(at(end + 0.001), 0.3, 1e-12);
  EXPECT_NEAR(at(0.025), kCutting, 1e-12);
}

TEST(Cut, SidesHoldUpToTheCuttingForceAndTheCutSwingsAlong) {
  Cut cut(kEntry);
  for (int i = 0; i <= 200; ++i) {
    (void)cut.step(kEntry + 1e-4 * i * kIn, kStiffness, kCutting);
  }
  const double length = glm::distance(cut.entry(), cut.end());
  const Vec3 across = glm::normalize(glm::cross(kIn, Vec3(0.0, 0.0, 1.0)));
  const Vec3 middle = kEntry + 0.01 * kIn;
  for (const double by : {0.0005, 0.001, 0.0019}) {
    const Vec3 force = cut.step(middle + by * across, kStiffness, kCutting);
    EXPECT_NEAR(glm::length(force + kStiffness * by * across), 0.0, 1e-12);
  }
  EXPECT_NEAR(glm::length(cut.step(middle, kStiffness, kCutting)), 0.0, 1e-12);
  const Vec3 force = cut.step(middle + 0.005 * across, kStiffness, kCutting);
  EXPECT_NEAR(glm::length(force), kCutting, 1e-12);
  EXPECT_NEAR(glm::distance(cut.entry(), cut.end()), length, 1e-12);
  EXPECT_NEAR(glm::dot(glm::normalize(cut.end() - cut.entry()),
                       glm::normalize(0.01 * kIn + 0.003 * across)),
              1.0, 1e-12);
}

// A tissue may be left beside and behind the point where it was entered: through a wall that is not
// perpendicular to the needle.
TEST(Cut, DrawnOutPastItsEntryTheTipIsHeldSidewaysOnly) {
  Cut cut(kEntry);
  for (int i = 0; i <= 200; ++i) {
    (void)cut.step(kEntry + 1e-4 * i * kIn, kStiffness, kCutting);
  }
  const Vec3 end = cut.end();
  const Vec3 across = glm::normalize(glm::cross(kIn, Vec3(0.0, 0.0, 1.0)));
  EXPECT_NEAR(glm::length(cut.step(kEntry - 0.002 * kIn, kStiffness, kCutting)), 0.0, 1e-12);
  Vec3 force = cut.step(kEntry - 0.002 * kIn + 0.001 * across, kStiffness, kCutting);
  EXPECT_NEAR(glm::length(force + 0.3 * across), 0.0, 1e-12);
  force = cut.step(kEntry - 0.002 * kIn + 0.005 * across, kStiffness, kCutting);
  EXPECT_NEAR(glm::length(force + kCutting * across), 0.0, 1e-12);
  EXPECT_EQ(cut.end(), end);
}

// On any way, all energy given back was stored before, and cutting only dissipates. Trapezoids
// suffice, as the force is continuous and the way in a tick is far below the lag.
TEST(Cut, NeverGivesEnergy) {
  std::mt19937 random(4);
  std::normal_distribution<double> change(0.0, 1e-6);
  Cut cut(kEntry);
  Vec3 tip = kEntry;
  Vec3 velocity(0.0);
  Vec3 force(0.0);
  double given = 0.0;
  for (int i = 0; i < 100000; ++i) {
    velocity = 0.98 * velocity + Vec3(change(random), change(random), change(random));
    velocity -= 1e-6 * (tip - kEntry);
    const Vec3 before = tip;
    tip += velocity;
    const Vec3 now = cut.step(tip, kStiffness, kCutting);
    given += glm::dot(0.5 * (force + now), tip - before);
    force = now;
    ASSERT_LE(given, 1e-9) << i;
    ASSERT_LE(glm::length(force), kCutting * (1.0 + 1e-12));
  }
  EXPECT_LT(given, -1e-3);
}

TEST(Cut, WithoutStiffnessOrForceItPushesNothing) {
  Cut cut(kEntry);
  EXPECT_EQ(cut.step(kEntry + 0.01 * kIn, 0.0, kCutting), Vec3(0.0));
  EXPECT_EQ(glm::length(cut.step(kEntry + 0.01 * kIn, kStiffness, 0.0)), 0.0);
  EXPECT_NEAR(glm::distance(cut.end(), kEntry + 0.01 * kIn), 0.0, 1e-15);
}

}  // namespace
}  // namespace palpate::test
