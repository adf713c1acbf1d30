// Shaft friction against the closed forms of Karnopp's law, in both directions, and its energy.

#include "palpate/contact/shaft_slip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::test {
namespace {

ShaftLaw liverLike() {
  ShaftLaw law;
  law.in = {18.0, 10.0, 290.0};
  law.out = {17.0, 11.0, 210.0};
  law.stiffness = 1e5;
  law.stick_speed = 1e-3;
  return law;
}

constexpr double kLength = 0.03;  // [m]

// The force after a long way at `speed` [m/s] with a constant length.
double slidingForce(double speed, double dt) {
  const ShaftLaw law = liverLike();
  ShaftSlip slip;
  double force = 0.0;
  for (int i = 0; i < 2000; ++i) force = slip.step(law, kLength, speed * dt, speed);
  EXPECT_TRUE(slip.isSliding());
  return force;
}

TEST(ShaftSlip, SlidesByItsLawEachWayAtEveryRate) {
  for (const double dt : {1e-3, 1e-4}) {
    EXPECT_NEAR(slidingForce(0.01, dt), kLength * (10.0 + 290.0 * 0.01), 1e-12);
    EXPECT_NEAR(slidingForce(0.05, dt), kLength * (10.0 + 290.0 * 0.05), 1e-12);
    EXPECT_NEAR(slidingForce(-0.01, dt), -kLength * (11.0 + 210.0 * 0.01), 1e-12);
  }
}

TEST(ShaftSlip, SticksUpToItsLimitAndBreaksAway) {
  const ShaftLaw law = liverLike();
  ShaftSlip slip;
  const double step = 1e-6;
  double highest = 0.0;
  for (int i = 1; i <= 180; ++i) {
    const double force = slip.step(law, kLength, step, 1e-3);
    EXPECT_NEAR(force, law.stiffness * kLength * i * step, 1e-9);
    highest = std::max(highest, force);
  }
  EXPECT_NEAR(highest, kLength * 18.0, 1e-9);
  EXPECT_NEAR(slip.step(law, kLength, step, 1e-3), kLength * (10.0 + 0.29), 1e-12);
  // Moving on slowly, it sticks at the force at which it slid, and the force rises again.
  const double again = slip.step(law, kLength, step, 0.5e-3);
  EXPECT_FALSE(slip.isSliding());
  EXPECT_NEAR(again, kLength * (10.0 + law.stiffness * step), 1e-12);
}

TEST(ShaftSlip, ACreepingHandFeelsASaw) {
  const ShaftLaw law = liverLike();
  ShaftSlip slip;
  int drops = 0;
  double before = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double force = slip.step(law, kLength, 1e-6, 0.5e-3);
    if (force < before - 0.1 * kLength * 8.0) ++drops;
    before = force;
    EXPECT_LE(force, kLength * (18.0 + 290.0 * 0.5e-3));
  }
  // From C to D the stretch grows by 80 um, then it slips: one drop every 80 ticks after the first
  // 180.
  EXPECT_NEAR(drops, (2000 - 180) / 80.0, 2.0);
}

TEST(ShaftSlip, LengthThatComesInIsUnstretched) {
  ShaftLaw law = liverLike();
  law.in.static_force = 1e9;
  ShaftSlip slip;
  const double force = slip.step(law, 0.01, 1e-4, 1.0);
  EXPECT_NEAR(force, 1e5 * 0.01 * 1e-4, 1e-12);
  EXPECT_NEAR(slip.step(law, 0.02, 0.0, 1.0), force, 1e-12);        // twice as long, the same force
  EXPECT_NEAR(slip.step(law, 0.01, 0.0, 1.0), 0.5 * force, 1e-12);  // half of it has left
  EXPECT_EQ(slip.step(law, 0.0, 0.0, 1.0), 0.0);
}

// Any way in and out that begins and ends at zero length: the hand never gains. Force k acts over
// step k + 1, as a device holds it; the trapezoidal rule removes that effect, so that only the
// model's own energy is left.
TEST(ShaftSlip, NeverGivesEnergy) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> change(-2e-5, 2e-5);
  const ShaftLaw law = liverLike();
  ShaftSlip slip;
  double depth = 0.0;
  double velocity = 0.0;
  double force = 0.0;
  double given = 0.0;
  for (int i = 0; i < 50000; ++i) {
    velocity = 0.98 * velocity + change(random);
    double next = depth + velocity;
    if (next < 0.0) {
      next = 0.0;
      velocity = 0.0;
    }
    const double advance = next - depth;
    depth = next;
    const double now = slip.step(law, depth, advance, advance / 1e-3);
    given -= 0.5 * (force + now) * advance;
    force = now;
    // Error of the trapezoidal rule: half of a tick's change of force times its way.
    ASSERT_LE(given, 1e-6) << i;
  }
  EXPECT_LT(given, -1e-3);
}

TEST(ShaftSlip, SlidingHarderThanItSticksCountsAsSticking) {
  ShaftLaw law = liverLike();
  law.in.kinetic_force = 30.0;
  ShaftSlip slip;
  double force = 0.0;
  for (int i = 0; i < 1000; ++i) force = slip.step(law, kLength, 1e-5, 0.0);
  EXPECT_LE(force, kLength * 18.0 + 1e-12);
}

}  // namespace
}  // namespace palpate::test
