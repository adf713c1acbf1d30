// A wall's law, with a height and any curve: its derivatives against differences, and its form in
// series with a stop against the definition.

#include "palpate/contact/wall_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "palpate/contact/series.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Linear, stiffening and Hertzian, each flat, raised and lowered.
std::vector<WallLaw> laws() {
  std::vector<WallLaw> out;
  for (const WallSpring& spring :
       {WallSpring{700.0, 0.0, 1.0, 1.0}, WallSpring{400.0, 2e5, 1.0, 1.0},
        WallSpring{900.0, 0.0, 1.5, 1e-3}, WallSpring{300.0, 5e4, 2.2, 1e-3}}) {
    for (const double height : {0.0, 0.2e-3, -0.15e-3}) {
      out.push_back({spring, height, 0.5, height == 0.0 ? kInfinity : 2e-3});
    }
  }
  return out;
}

TEST(WallLaw, ForceIsTheSlopeOfTheEnergyAndTangentThatOfTheForce) {
  constexpr double kStep = 1e-8;
  for (const WallLaw& law : laws()) {
    // Depths away from the kinks: where the limit of the height ends (0.4 and 0.3 mm), and where
    // its fading begins and ends (2 and 4 mm).
    for (const double depth : {0.05e-3, 0.2e-3, 0.6e-3, 1.5e-3, 2.7e-3, 4.5e-3}) {
      const double force = (law.energy(depth + kStep) - law.energy(depth - kStep)) / (2.0 * kStep);
      const double tangent = (law.force(depth + kStep) - law.force(depth - kStep)) / (2.0 * kStep);
      // Rounding of an energy of some mJ, divided by the step.
      EXPECT_NEAR(law.force(depth), force, 1e-6 * (1.0 + std::fabs(force))) << depth;
      EXPECT_NEAR(law.tangent(depth), tangent, 1e-5 * (1.0 + std::fabs(tangent))) << depth;
    }
  }
}

TEST(SharedWall, RisesByAllThatChangesFromPlaceToPlace) {
  Random random(9);
  for (const WallLaw& law : laws()) {
    for (const double depth : {0.05e-3, 0.6e-3, 1.5e-3, 2.7e-3}) {
      SharedWall felt;
      felt.law = law;
      if (law.height != 0.0) felt.height_rise = 0.2 * random.direction();
      felt.stiffness_rise = 3e4 * random.direction();
      felt.stiffening_rise = 1e7 * random.direction();
      const Vec3 along = random.direction();
      const auto energy = [&](double way) {
        WallLaw there = law;
        there.height += way * glm::dot(felt.height_rise, along);
        there.spring.stiffness += way * glm::dot(felt.stiffness_rise, along);
        there.spring.stiffening += way * glm::dot(felt.stiffening_rise, along);
        return there.energy(depth);
      };
      constexpr double kStep = 1e-8;
      const double expected = (energy(kStep) - energy(-kStep)) / (2.0 * kStep);
      EXPECT_NEAR(glm::dot(felt.rise(depth), along), expected, 1e-6 * (1.0 + std::fabs(expected)))
          << law.height << " " << depth;
    }
  }
}

TEST(SoftWall, GivesWayByWhatTheStopDoesNot) {
  Random random(10);
  int bent = 0;
  for (const WallLaw& law : laws()) {
    for (const double stop : {1200.0, 4000.0, 50000.0}) {
      double last = 0.0;
      double last_give = 0.0;
      for (int i = 0; i < 40; ++i) {
        const double give = last_give + random.uniform(1e-6, 0.1e-3);
        const SoftWall soft = softWall(law, stop, give);
        // The two springs in series have the same force, and the whole depth is the sum of their
        // compressions.
        EXPECT_NEAR(soft.depth - soft.force / stop, give, 1e-9 * give + 1e-15) << stop;
        // Where the law is less stiff than the stop allows, the soft wall follows the law; from
        // there on it is a straight line with the largest slope.
        if (law.tangent(soft.depth) < 0.98 * stop) {
          EXPECT_LE(soft.force, law.force(soft.depth) * (1.0 + 1e-9));
        }
        bent += soft.force < 0.999 * law.force(soft.depth) ? 1 : 0;
        EXPECT_GE(soft.force, last - 1e-12) << "deeper is never softer";
        last = soft.force;
        const double step = 1e-4 * give;
        const double slope =
            (softWall(law, stop, give + step).force - softWall(law, stop, give - step).force) /
            (2.0 * step);
        // Steps that contain a kink of the law are skipped: there the slopes on both sides differ.
        const double before = (soft.force - softWall(law, stop, give - step).force) / step;
        const double after = (softWall(law, stop, give + step).force - soft.force) / step;
        if (std::fabs(after - before) < 1e-3 * std::fabs(slope)) {
          EXPECT_NEAR(soft.tangent, slope, 2e-3 * std::fabs(slope)) << stop << " " << give;
        }
        last_give = give;
      }
    }
  }
  EXPECT_GT(bent, 50) << "laws that the stop bends are among them";
}

}  // namespace
}  // namespace palpate::test
