// The bounded memory of holes, and of ports that rest after they gave way.

#include "palpate/interior/punctures.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

Port portWith(double radius, double reopens_at, double rearm) {
  Port port;
  port.opens_at = 2.0;
  port.hole_radius = radius;
  port.reopens_at = reopens_at;
  port.rearm = rearm;
  return port;
}

TEST(Punctures, AHoleReachesAsFarAsItsRadiusAndIsItsPortsOnly) {
  Punctures punctures;
  punctures.puncture(3, portWith(1e-3, 0.5, 0.0), Vec3(1.0, 0.0, 0.0));
  ASSERT_EQ(punctures.holes().size(), 1U);
  const Hole* hole = punctures.holeAt(3, Vec3(1.0, 0.0, 0.9e-3));
  ASSERT_NE(hole, nullptr);
  EXPECT_EQ(hole->reopens_at, 0.5);
  EXPECT_EQ(punctures.holeAt(3, Vec3(1.0, 0.0, 1.1e-3)), nullptr);
  EXPECT_EQ(punctures.holeAt(4, Vec3(1.0, 0.0, 0.0)), nullptr);
  EXPECT_TRUE(punctures.anyAt(Vec3(1.0, 0.9e-3, 0.0)));
  EXPECT_FALSE(punctures.anyAt(Vec3(1.0, 1.1e-3, 0.0)));
}

TEST(Punctures, InAHoleNoSecondOneIsMade) {
  Punctures punctures;
  const Port port = portWith(1e-3, 0.5, 0.0);
  punctures.puncture(3, port, Vec3(0.0));
  punctures.puncture(3, port, Vec3(0.5e-3, 0.0, 0.0));
  EXPECT_EQ(punctures.holes().size(), 1U);
  punctures.puncture(4, port, Vec3(0.0));  // the wall of another port may be there as well
  EXPECT_EQ(punctures.holes().size(), 2U);
  punctures.puncture(5, portWith(0.0, 0.0, 0.0), Vec3(1.0));
  EXPECT_EQ(punctures.holes().size(), 2U) << "a port that makes none";
}

TEST(Punctures, ForgetsTheOldestHoleWhenFull) {
  Punctures punctures;
  const Port port = portWith(1e-3, 0.5, 0.0);
  const auto at = [](std::size_t i) { return Vec3(0.01 * static_cast<double>(i), 0.0, 0.0); };
  for (std::size_t i = 0; i < Punctures::kMaxHoles + 2; ++i) punctures.puncture(0, port, at(i));
  EXPECT_EQ(punctures.holes().size(), Punctures::kMaxHoles);
  EXPECT_EQ(punctures.holeAt(0, at(0)), nullptr);
  EXPECT_EQ(punctures.holeAt(0, at(1)), nullptr);
  for (std::size_t i = 2; i < Punctures::kMaxHoles + 2; ++i) {
    EXPECT_NE(punctures.holeAt(0, at(i)), nullptr) << i;
  }
}

TEST(Punctures, APortRestsUntilTheProxyWasFarEnough) {
  Punctures punctures;
  punctures.puncture(3, portWith(0.0, 0.0, 0.5e-3), Vec3(0.0));
  punctures.visit(Vec3(0.0, 0.0, -0.4e-3));
  EXPECT_EQ(punctures.restOf(3), 0.5e-3);
  EXPECT_EQ(punctures.restOf(4), 0.0);
  punctures.visit(Vec3(0.0, 0.0, -0.6e-3));
  EXPECT_EQ(punctures.restOf(3), 0.0);
}

TEST(Punctures, ARestBeginsAnewAndTheOldestEndsWhenFull) {
  Punctures punctures;
  const Port port = portWith(0.0, 0.0, 0.5e-3);
  punctures.puncture(3, port, Vec3(0.0));
  punctures.puncture(3, port, Vec3(1.0));
  punctures.visit(Vec3(1.0));
  EXPECT_EQ(punctures.restOf(3), 0.5e-3) << "counted from the last time";
  for (PortId id = 4; id < 4 + Punctures::kMaxResting; ++id)
    punctures.puncture(id, port, Vec3(1.0));
  EXPECT_EQ(punctures.restOf(3), 0.0);
  EXPECT_EQ(punctures.restOf(4), 0.5e-3);
  EXPECT_EQ(punctures.restOf(3 + Punctures::kMaxResting), 0.5e-3);
  punctures.clear();
  EXPECT_EQ(punctures.restOf(4), 0.0);
}

TEST(Punctures, OfPortsThatASceneHasNotAreTold) {
  Punctures holes;
  holes.puncture(3, portWith(1e-3, 0.5, 0.0), Vec3(0.0));
  EXPECT_TRUE(holes.isOf(4));
  EXPECT_FALSE(holes.isOf(3));
  Punctures rests;
  rests.puncture(2, portWith(0.0, 0.0, 0.5e-3), Vec3(0.0));
  rests.puncture(5, portWith(0.0, 0.0, 0.5e-3), Vec3(0.0));
  EXPECT_TRUE(rests.isOf(6));
  EXPECT_FALSE(rests.isOf(5));
}

}  // namespace
}  // namespace palpate::test
