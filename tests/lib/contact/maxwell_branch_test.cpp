// The Maxwell branch against the closed forms of a ramp and of relaxation, at any tick rate, and
// its energy.

#include "palpate/contact/maxwell_branch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::test {
namespace {

constexpr double kTime = 0.05;  // [s]

TEST(MaxwellBranch, RampAndRelaxationAreExactAtEveryRate) {
  for (const double dt : {1e-2, 1e-3, 1e-4}) {
    MaxwellBranch branch;
    const double speed = 0.02;
    const int ticks = static_cast<int>(std::lround(0.1 / dt));
    for (int i = 1; i <= ticks; ++i) {
      branch.step(speed * dt, dt, kTime);
      const double t = i * dt;
      EXPECT_NEAR(branch.stretch(), speed * kTime * -std::expm1(-t / kTime), 1e-14);
    }
    const double held = branch.stretch();
    for (int i = 1; i <= ticks; ++i) {
      branch.step(0.0, dt, kTime);
      EXPECT_NEAR(branch.stretch(), held * std::exp(-i * dt / kTime), 1e-14);
    }
  }
}

TEST(MaxwellBranch, AJumpIsASpringAndNoTimeIsNone) {
  MaxwellBranch branch;
  branch.step(1e-3, 0.0, kTime);
  EXPECT_EQ(branch.stretch(), 1e-3);
  branch.step(-3e-3, 0.0, kTime);
  branch.keepAbove(-1e-3);
  EXPECT_EQ(branch.stretch(), -1e-3);
  branch.step(kTime, 1e-3, 1e-300);  // a dashpot that yields at once
  EXPECT_NEAR(branch.stretch(), 0.0, 1e-12);
}

// The work is computed by the trapezoidal rule from the force at both ends of each tick. The branch
// is a spring in series with a dashpot, so from rest the hand can only lose.
TEST(MaxwellBranch, GivesBackNoMoreThanItWasGiven) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(-1e-4, 1e-4);
  MaxwellBranch branch;
  double work_in = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double by = step(random);
    const double before = branch.stretch();
    branch.step(by, 1e-3, kTime);
    // During a tick the force is that of stretch(s), s from 0 to dt; its mean times `by` is the
    // work, integrated numerically from the closed form in steps much finer than the tick.
    double mean = 0.0;
    constexpr int kParts = 8;
    for (int k = 0; k < kParts; ++k) {
      const double share = (k + 0.5) / kParts;
      MaxwellBranch part;
      part.step(before, 0.0, kTime);
      part.step(share * by, share * 1e-3, kTime);
      mean += part.stretch() / kParts;
    }
    work_in += mean * by;
    ASSERT_GE(work_in, -1e-12);
  }
}

}  // namespace
}  // namespace palpate::test
