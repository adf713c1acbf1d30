// The sideways force of a tissue on a shaft: the closed form, the channel computed point by point,
// and its energy on any way.

#include "palpate/contact/shaft_channel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kStiffness = 4e4;  // [N/m^2]

Vec3 turned(double angle) { return {std::sin(angle), 0.0, -std::cos(angle)}; }

// A needle 25 mm deep, turned about its hole: stiffness L^2 sin(angle) / 3, perpendicular to the
// needle and directed back.
TEST(ShaftChannel, TurnedAboutTheHoleItIsTheClosedForm) {
  const double length = 0.025;
  for (const double angle : {0.0, 0.01, 0.12, 0.6, -0.3}) {
    ShaftChannel channel;
    (void)channel.step({kStiffness}, 0.0, length, turned(0.0));
    const Vec3 force = channel.step({kStiffness}, 0.0, length, turned(angle)) / length;
    const double expected = kStiffness * length * length * std::sin(angle) / 3.0;
    const Vec3 back(-std::cos(angle), 0.0, -std::sin(angle));
    EXPECT_NEAR(glm::length(force - expected * back), 0.0, 1e-12) << angle;
  }
}

TEST(ShaftChannel, APartOfTheShaftPushesByWhereItIs) {
  ShaftChannel channel;
  (void)channel.step({kStiffness}, 0.01, 0.03, turned(0.0));
  const Vec3 moment = channel.step({kStiffness}, 0.01, 0.03, turned(0.1));
  // The integral of s^2 from 10 to 30 mm.
  EXPECT_NEAR(glm::length(moment), kStiffness * 26e-6 / 3.0 * std::sin(0.1), 1e-12);
}

// Against a channel stored point by point: a spring for each piece of length, which is unstretched
// where the needle enters.
TEST(ShaftChannel, IsTheChannelPointByPointWhileTheNeedleGoesIn) {
  Random random(3);
  struct Bit {
    double from, to;
    Vec3 direction;
  };
  for (int run = 0; run < 50; ++run) {
    ShaftChannel channel;
    std::vector<Bit> bits;
    double end = 0.0;
    const double begin = run % 2 == 0 ? 0.0 : 0.007;
    Vec3 direction = random.direction();
    for (int i = 0; i < 400; ++i) {
      direction = glm::normalize(direction + 0.01 * random.direction());
      const double before = std::max(end, begin);
      end = before + random.uniform(0.0, 2e-4);
      bits.push_back({before, end, direction});
      const Vec3 moment = channel.step({kStiffness}, begin, end, direction);
      Vec3 expected(0.0);
      for (const Bit& bit : bits) {
        const double weight = (std::pow(bit.to, 3) - std::pow(bit.from, 3)) / 3.0;
        expected += kStiffness * weight * (bit.direction - direction);
      }
      expected -= glm::dot(expected, direction) * direction;
      ASSERT_NEAR(glm::length(moment - expected), 0.0, 1e-12) << run << ", " << i;
    }
  }
}

TEST(ShaftChannel, BeyondItsStrengthTheTissueTearsAndStaysWhereItIs) {
  const double length = 0.03;
  const double strength = 50.0;  // [N/m]
  ShaftChannel channel;
  (void)channel.step({kStiffness, strength}, 0.0, length, turned(0.0));
  // The mean load is stiffness times half of the length times the difference of the directions.
  const double apart = strength / (kStiffness * 0.5 * length);
  for (double angle = 0.0; angle < 1.0; angle += 0.01) {
    const double chord = 2.0 * std::sin(0.5 * angle);
    const double held = std::min(chord, apart);
    const double expected = kStiffness * std::pow(length, 3) / 3.0 * held *
                            std::cos(0.5 * std::min(angle, 2.0 * std::asin(0.5 * apart)));
    const Vec3 moment = channel.step({kStiffness, strength}, 0.0, length, turned(angle));
    // After tearing, the channel follows along the chord: exact to the second order of its lag.
    ASSERT_NEAR(glm::length(moment), expected, 0.01 * expected + 1e-12) << angle;
    ASSERT_LE(glm::length(moment), kStiffness * std::pow(length, 3) / 3.0 * apart + 1e-12);
  }
  // When the needle is turned back by as much as the tissue was pushed aside, the tissue is slack,
  // short of where it was cut.
  const double slack = 0.99 - 2.0 * std::asin(0.5 * apart);
  EXPECT_NEAR(glm::length(channel.step({kStiffness, strength}, 0.0, length, turned(slack))), 0.0,
              0.03 * kStiffness * std::pow(length, 3) / 3.0 * apart);
}

// In, out, around, with or without tearing: the tip never gets back more energy than it gave.
TEST(ShaftChannel, NoWayGivesEnergy) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const ChannelLaw law{kStiffness, seed % 2 == 0 ? kInfinity : 60.0};
    ShaftChannel channel;
    const double begin = seed % 3 == 0 ? 0.004 : 0.0;
    Vec3 tip(0.0, 0.0, -0.001);
    Vec3 way(0.0);
    Vec3 force(0.0);
    double work = 0.0;
    double moved = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      way += 2e-6 * random.direction() - 2e-4 * (tip + Vec3(0.0, 0.0, 0.02)) * 1e-2 - 0.01 * way;
      const Vec3 last = tip;
      tip += way;
      const double reach = glm::length(tip);
      const Vec3 now = channel.step(law, begin, reach, tip / reach) / reach;
      const double gave = 0.5 * glm::dot(force + now, tip - last);
      work += gave;
      moved += std::fabs(gave);
      force = now;
      // The trapezoidal rule has an error of third order in the step of 20 um at 25 mm.
      ASSERT_LE(work, 1e-5 * moved + 1e-12) << seed << ", " << i;
    }
    EXPECT_LT(work, 0.0);
  }
}

TEST(ShaftChannel, OutOfTheTissueItIsForgotten) {
  ShaftChannel channel;
  (void)channel.step({kStiffness}, 0.0, 0.02, turned(0.0));
  EXPECT_GT(glm::length(channel.step({kStiffness}, 0.0, 0.02, turned(0.2))), 0.0);
  EXPECT_EQ(channel.step({kStiffness}, 0.0, 0.0, turned(0.2)), Vec3(0.0));
  EXPECT_EQ(channel.moment(), 0.0);
  EXPECT_EQ(channel.step({kStiffness}, 0.0, 0.02, turned(0.4)), Vec3(0.0));
}

}  // namespace
}  // namespace palpate::test
