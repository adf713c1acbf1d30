// The Falcon's arms: against the chain of their links, finite differences and virtual work.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "falcon/kinematics.h"

namespace palpate::devices::falcon {
namespace {

const Geometry kGeometry;
constexpr double kDegree = std::numbers::pi / 180.0;

/// A random place of the workspace: the reachable part of +-50 mm about 0.125 m.
template <class Random>
Vec3 place(Random& random) {
  std::uniform_real_distribution<double> across(-0.05, 0.05);
  std::uniform_real_distribution<double> up(0.075, 0.175);
  while (true) {
    const Vec3 p(across(random), across(random), up(random));
    if (armsAt(p)) return p;
  }
}

/// A random place of the nominal workspace, 0.1 m across, about its middle: there no arm is close
/// to stretched, as some are in the corners of the cube.
template <class Random>
Vec3 nominalPlace(Random& random) {
  while (true) {
    const Vec3 p = place(random);
    if (glm::length(p - Vec3(0.0, 0.0, 0.125)) <= 0.05) return p;
  }
}

/// The grip's position found by following the links of leg `i`: thigh, hinge, parallelogram, hinge,
/// grip. `shin` and `tilt` are the parallelogram's angles.
Vec3 chain(int i, double thigh, double shin, double tilt) {
  const Geometry& g = kGeometry;
  const double lower = 0.01125 + g.shin * std::sin(tilt) + 0.01125;
  const double u = g.thigh * std::cos(thigh) + lower * std::cos(shin) - g.grip;
  const double v = g.shin * std::cos(tilt) - g.sideways;
  const double w = g.thigh * std::sin(thigh) + lower * std::sin(shin);
  const double azimuth = (90.0 - 120.0 * i + g.turn) * kDegree;
  const double out = u + g.radius;
  const double side = v + g.shift;
  return {std::cos(azimuth) * out - std::sin(azimuth) * side,
          std::sin(azimuth) * out + std::cos(azimuth) * side, w};
}

TEST(FalconKinematics, EachLegsChainOfLinksEndsAtTheGrip) {
  std::mt19937 random(3);
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 p = place(random);
    const auto arms = armsAt(p);
    ASSERT_TRUE(arms);
    for (int i = 0; i < 3; ++i) {
      // The parallelogram's two angles are free: those that reach p follow from the knee's
      // position.
      const double azimuth = (90.0 - 120.0 * i + kGeometry.turn) * kDegree;
      const double u = std::cos(azimuth) * p.x + std::sin(azimuth) * p.y - kGeometry.radius;
      const double v = -std::sin(azimuth) * p.x + std::cos(azimuth) * p.y - kGeometry.shift;
      const double tilt = std::acos((v + kGeometry.sideways) / kGeometry.shin);
      const double shin =
          std::atan2(p.z - kGeometry.thigh * std::sin(arms->angles[i]),
                     u + kGeometry.grip - kGeometry.thigh * std::cos(arms->angles[i]));
      ASSERT_LT(glm::length(chain(i, arms->angles[i], shin, tilt) - p), 1e-12) << i;
    }
  }
}

TEST(FalconKinematics, OnTheAxisTheAnglesAreThoseOfThePublishedTable) {
  // Devices measured in the public sources: z [m], thigh [degrees].
  const double table[][2] = {{0.090, -1.1}, {0.110, 16.2}, {0.125, 27.7}, {0.150, 47.2}};
  for (const auto& row : table) {
    const auto arms = armsAt(Vec3(0.0, 0.0, row[0]));
    ASSERT_TRUE(arms);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(arms->angles[i] / kDegree, row[1], 0.05);
  }
}

TEST(FalconKinematics, ThereAndBackOverTheWorkspace) {
  const unsigned seed = 17;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  double worst = 0.0;
  int most_cold = 0;
  for (int n = 0; n < 50'000; ++n) {
    const Vec3 p = place(random);
    const auto back = gripAt(armsAt(p)->angles, middle());
    ASSERT_TRUE(back) << p.x << " " << p.y << " " << p.z;
    worst = std::max(worst, glm::length(back->position - p));
    most_cold = std::max(most_cold, back->iterations);
  }
  EXPECT_LE(worst, 1e-9);
  RecordProperty("worst_m", std::to_string(worst));
  std::printf("round trip: worst %.2e m, at most %d iterations from the middle\n", worst,
              most_cold);
}

TEST(FalconKinematics, FromTheLastPoseAtMostFourIterations) {
  const unsigned seed = 18;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  // 1 mm in a tick: a hand at 1 m/s.
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  int most = 0;
  double sum = 0.0;
  constexpr int kPoses = 50'000;
  for (int n = 0; n < kPoses;) {
    const Vec3 p = nominalPlace(random);
    const Vec3 q = p + 1e-3 * unitOr(Vec3(part(random), part(random), part(random)), Vec3(0.0));
    const auto arms = armsAt(q);
    if (!arms) continue;
    const auto found = gripAt(arms->angles, p);
    ASSERT_TRUE(found);
    ASSERT_LE(glm::length(found->position - q), 1e-9);
    most = std::max(most, found->iterations);
    sum += found->iterations;
    ++n;
  }
  EXPECT_LE(most, 4);
  std::printf("warm Newton: %.2f iterations on average, at most %d\n", sum / kPoses, most);
}

TEST(FalconKinematics, TheSlopeIsThatOfFiniteDifferences) {
  std::mt19937 random(5);
  constexpr double kStep = 1e-6;  // [m]
  for (int n = 0; n < 5'000; ++n) {
    const Vec3 p = nominalPlace(random);
    const auto arms = armsAt(p);
    for (int k = 0; k < 3; ++k) {
      Vec3 d(0.0);
      d[k] = kStep;
      const auto more = armsAt(p + d);
      const auto less = armsAt(p - d);
      if (!more || !less) continue;
      const Vec3 slope = (more->angles - less->angles) / (2.0 * kStep);
      // Close to a stretched arm the derivative is large, and so is the error of the differences.
      const double scale = 1.0 + glm::dot(slope, slope) / 400.0;
      ASSERT_LT(glm::length(slope - arms->slope[k]), 1e-5 * scale) << n;
    }
  }
}

TEST(FalconKinematics, TheMotorsDoTheWorkThatTheHandFeels) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> part(-8.0, 8.0);
  for (int n = 0; n < 5'000; ++n) {
    const Vec3 p = place(random);
    const auto arms = armsAt(p);
    const Vec3 force(part(random), part(random), part(random));
    const auto torques = torquesFor(force, *arms);
    ASSERT_TRUE(torques);
    for (int k = 0; k < 3; ++k) {
      // A small motion along axis k: force times way is torque times angle.
      ASSERT_NEAR(force[k], glm::dot(*torques, arms->slope[k]), 1e-9 * glm::length(force));
    }
  }
}

TEST(FalconKinematics, WhereTheGripCannotBeThereIsNoAnswerAndNoNan) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (int n = 0; n < 4'000; ++n) {
    const Vec3 anything(part(random), part(random), part(random));
    if (const auto arms = armsAt(anything)) {
      ASSERT_TRUE(isFinite(arms->angles));
    }
    const auto found = gripAt(7.0 * anything, middle());
    if (found) {
      const auto back = armsAt(found->position);
      ASSERT_TRUE(back);
      ASSERT_LT(glm::length(back->angles - 7.0 * anything), 1e-6);
    }
  }
  EXPECT_FALSE(armsAt(Vec3(std::nan(""))));
  EXPECT_FALSE(gripAt(Vec3(std::nan("")), middle()));
}

}  // namespace
}  // namespace palpate::devices::falcon
