// Walls that rupture under a force: when they do, what they leave behind, and what the result
// reports of it.

#include <gtest/gtest.h>

#include <cmath>

#include "lib/render/drive.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

using How = PortCrossing::How;

constexpr double kStiffness = 1000.0;  // [N/m]
constexpr double kStep =
    0.01e-3;  // [m] in a tick: the force at which a wall ruptures is off by up to 0.01 N

/// Flesh below z = 0, under a skin of 1000 N/m with one port.
std::string skin(const std::string& port, const std::string& material = {}) {
  return R"(
palpate: 1
length: mm
fields: {below: {box: {center: [0, 0, -50], size: [200, 200, 100]}}}
materials: {skin: {stiffness: 1000 N/m)" +
         material + R"(}}
layers: [{name: flesh, inside: below, wall: skin}]
ports: [{name: cut, between: [outside, flesh], )" +
         port + "}]\n";
}

/// Straight to `hip` in small steps until a port is passed: the crossing, or no value.
std::optional<PortCrossing> pressTo(Drive& drive, const Vec3& hip, double step = kStep) {
  const Vec3 from = drive.hip();
  const int n = static_cast<int>(std::ceil(glm::length(hip - from) / step));
  for (int i = 1; i <= n; ++i) {
    (void)drive.to(from + (static_cast<double>(i) / n) * (hip - from));
    const auto crossings = drive.renderer().crossings();
    if (!crossings.empty()) return crossings.front();
  }
  return std::nullopt;
}

TEST(Puncture, GivesWayAtItsForceBothWaysAndTellsWhereAndHow) {
  Drive drive(sceneOf(skin("opens_at: 2 N, back: 1 N")));
  (void)drive.to(mm(3, 4, 5));
  auto crossing = pressTo(drive, mm(3, 4, -1.99));
  EXPECT_FALSE(crossing) << "less than its force";
  EXPECT_NEAR(drive.last().force.z, 1.99, 1e-9);
  crossing = pressTo(drive, mm(3, 4, -5));
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->how, How::kPuncture);
  EXPECT_EQ(crossing->from, kOutside);
  EXPECT_EQ(crossing->to, 1);
  EXPECT_TRUE(isNear(crossing->point, mm(3, 4, 0), 1e-9));
  EXPECT_TRUE(isNear(crossing->normal, Vec3(0, 0, 1), 1e-12));
  EXPECT_GE(crossing->force, 2.0);
  EXPECT_LE(crossing->force, 2.0 + kStiffness * kStep + 1e-9);
  EXPECT_EQ(drive.last().force, Vec3(0.0)) << "nothing holds it any more";
  EXPECT_EQ(drive.last().proxy, drive.hip());
  crossing = pressTo(drive, mm(3, 4, 5));
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->how, How::kPuncture) << "the port makes no holes";
  EXPECT_EQ(crossing->from, 1);
  EXPECT_EQ(crossing->to, kOutside);
  EXPECT_TRUE(isNear(crossing->normal, Vec3(0, 0, -1), 1e-12));
  EXPECT_NEAR(crossing->force, 1.0, kStiffness * kStep + 1e-9);
  EXPECT_NEAR(drive.hip().z, 1e-3, kStep + 1e-12);
}

TEST(Puncture, InAHoleTheReopeningForceCountsBesideItTheWalls) {
  for (const double reopens : {0.0, 0.3}) {
    SCOPED_TRACE(reopens);
    Drive drive(sceneOf(skin("opens_at: 2 N, back: 1 N, hole: {radius: 1, reopens_at: " +
                             std::to_string(reopens) + " N}")));
    (void)drive.to(mm(0, 0, 5));
    auto crossing = pressTo(drive, mm(0, 0, -5));
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->how, How::kPuncture);
    (void)drive.walk(mm(0, 0, -5));
    // Back by the hole, and in and out through it again off its middle, to the left and right of
    // its rim.
    crossing = pressTo(drive, mm(0, 0, 5));
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->how, How::kHole);
    EXPECT_NEAR(crossing->force, reopens, kStiffness * kStep + 1e-9);
    for (const double x : {0.95, -0.5, 1.05, 0.95}) {
      SCOPED_TRACE(x);
      (void)drive.walk(mm(0, 0, 5));
      (void)drive.walk(mm(x, 0, 5));
      crossing = pressTo(drive, mm(x, 0, -5));
      ASSERT_TRUE(crossing);
      const bool in_hole = std::fabs(x) < 1.0;
      EXPECT_EQ(crossing->how, in_hole ? How::kHole : How::kPuncture);
      EXPECT_NEAR(crossing->force, in_hole ? reopens : 2.0, kStiffness * kStep + 1e-9);
      (void)drive.walk(mm(x, 0, -5));
      (void)drive.walk(mm(0, 0, -5));
      (void)drive.walk(mm(0, 0, 5));
    }
    EXPECT_EQ(drive.region(), "outside");
    drive.renderer().reset();
    (void)drive.to(mm(0, 0, 5));
    crossing = pressTo(drive, mm(0, 0, -5));
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->how, How::kPuncture) << "a new start knows no holes";
  }
}

TEST(Puncture, AnOpenHoleIsAnOpeningFromEverySideAndSpeed) {
  Drive drive(sceneOf(skin("opens_at: 2 N, hole: {radius: 3}")));
  (void)drive.to(mm(0, 0, 5));
  (void)drive.walk(mm(0, 0, -5));
  ASSERT_EQ(drive.region(), "flesh");
  Random random(5);
  int through = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 from = drive.hip();
    const double side = random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0;
    const Vec3 hip =
        mm(random.uniform(-6, 6), random.uniform(-6, 6), side * random.uniform(0.2, 1.5));
    const bool was_free = drive.last().proxy == from;
    const TickResult out = drive.to(hip);
    if (!was_free || from.z * hip.z > 0.0) continue;
    // The proxy went straight: through the hole, or against the wall beside it (and along that to
    // the hole).
    const Vec3 p = from - from.z / (hip.z - from.z) * (hip - from);
    const double off = std::hypot(p.x, p.y);
    if (off < 3e-3 - 1e-8) {
      ASSERT_EQ(out.proxy, hip) << i;
      ASSERT_EQ(out.force, Vec3(0.0)) << i;
      ASSERT_EQ(drive.renderer().crossings().front().how, How::kHole) << i;
      ++through;
    } else if (out.proxy == hip) {
      ASSERT_EQ(out.event_count, 1) << i;
      const PortCrossing& crossing = drive.renderer().crossings().front();
      ASSERT_LE(std::hypot(crossing.point.x, crossing.point.y), 3e-3 + 1e-8) << i;
    } else {
      ASSERT_NEAR(out.proxy.z, 0.0, 1e-9) << i;
    }
  }
  EXPECT_GT(through, 1000);
}

TEST(Puncture, TwoPortsInOneWallTheHoleOfTheHarderOneCounts) {
  // The hand goes in through `cut` with 2 N, whose hole opens easily; on the way back, `b` alone
  // would be weaker.
  Drive drive(
      sceneOf(skin("opens_at: 2 N, back: 1.5 N, hole: {radius: 2, reopens_at: 0.1 N}},\n"
                   "  {name: b, between: [outside, flesh], opens_at: 3 N, back: 1 N")));
  (void)drive.to(mm(0, 0, 5));
  (void)drive.walk(mm(0, 0, -5));
  ASSERT_EQ(drive.events(), "cut");
  auto crossing = pressTo(drive, mm(0, 0, 5));
  ASSERT_TRUE(crossing);
  EXPECT_EQ(drive.events(), "cut");
  EXPECT_NEAR(crossing->force, 0.1, 0.011);
  (void)drive.walk(mm(0, 0, 5));
  (void)drive.walk(mm(10, 0, 5));
  (void)drive.walk(mm(10, 0, -5));
  ASSERT_EQ(drive.events(), "cut");
  (void)drive.walk(mm(20, 0, -5));
  crossing = pressTo(drive, mm(20, 0, 5));
  ASSERT_TRUE(crossing);
  EXPECT_EQ(drive.events(), "b") << "far from every hole";
}

/// Number of ports passed by a hand that trembles around the skin.
int tremble(const std::string& port, double amplitude, std::uint64_t seed) {
  Drive drive(sceneOf(skin(port)));
  (void)drive.to(mm(0, 0, 2));
  (void)drive.walk(mm(0, 0, 0));
  Random random(seed);
  int events = 0;
  for (int i = 0; i < 5000; ++i) {
    events += drive.to({0.0, 0.0, random.uniform(-amplitude, amplitude)}).event_count;
  }
  return events;
}

TEST(Puncture, APortThatRestsDoesNotChatter) {
  // The wall ruptures at a depth of 0.05 mm, and the hand trembles by 0.24 mm around that.
  const std::string weak = "opens_at: 0.05 N, back: 0.05 N";
  const double amplitude = 0.24e-3;
  EXPECT_GT(tremble(weak, amplitude, 3), 1000) << "what rearm is for";
  EXPECT_EQ(tremble(weak + ", rearm: 0.5 mm", amplitude, 3), 1);
  EXPECT_EQ(tremble("opens_at: 0.05 N, back: 0 N, rearm: 0.5 mm", amplitude, 3), 2)
      << "in, out by the way that is always open, and then no more";
  EXPECT_EQ(tremble(weak + ", rearm: 0.5 mm, hole: {radius: 1, reopens_at: 0.02 N}", amplitude, 3),
            1);
}

TEST(Puncture, ARestEndsFarAwayOrUnderAHandFarBeyondTheWall) {
  Drive drive(sceneOf(skin("opens_at: 0.1 N, back: 0.1 N, rearm: 0.5 mm")));
  (void)drive.to(mm(0, 0, 1));
  ASSERT_TRUE(pressTo(drive, mm(0, 0, -0.3)));
  // The proxy was never 0.5 mm inside, so the port rests until the hand is that far beyond the
  // wall.
  auto crossing = pressTo(drive, mm(0, 0, 2));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->force, 0.5, 0.011);
  (void)drive.walk(mm(0, 0, 2));
  crossing = pressTo(drive, mm(0, 0, -2));
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->force, 0.1, 0.011) << "it was far away";
}

TEST(Puncture, OnlyTheElasticNormalForceOfThisTickCounts) {
  // Friction, damping and motion along the wall make the total force several times larger than 2 N.
  Drive drive(sceneOf(skin("opens_at: 2 N", ", damping: 10 N.s/m, friction: {static: 1.5}")));
  (void)drive.to(mm(0, 0, 1));
  (void)drive.walk(mm(0, 0, -1.9));
  double most = 0.0;
  for (int i = 1; i <= 200; ++i) {
    const double side = i % 2 == 0 ? 2.0 : -2.0;  // [mm] back and forth, 4 m/s
    const TickResult out = drive.to(mm(side, 0, -1.9));
    most = std::max(most, glm::length(out.force));
    ASSERT_EQ(out.event_count, 0) << i;
  }
  EXPECT_GT(most, 20.0);
  // The previous tick does not count either: after a lighter press, a sufficient one opens the wall
  // in that tick.
  (void)drive.to(mm(0, 0, 1));
  EXPECT_EQ(drive.to(mm(0, 0, -1.99)).event_count, 0);
  EXPECT_EQ(drive.to(mm(0, 0, 0.1)).event_count, 0);
  EXPECT_EQ(drive.to(mm(0, 0, -2.01)).event_count, 1);
  EXPECT_NEAR(drive.renderer().crossings().front().force, 2.01, 1e-9);
}

TEST(Puncture, ForceLimitsDoNotHoldBackWhatOpensAWall) {
  // The hand feels at most 0.5 N, limited; the wall ruptures by the force of its spring.
  RendererSettings settings;
  settings.limits.max_force = 0.5;
  settings.limits.max_growth = 10.0;
  Drive drive(sceneOf(skin("opens_at: 2 N")), RendererKind::kConstraint, settings);
  (void)drive.to(mm(0, 0, 1));
  (void)drive.walk(mm(0, 0, -1.95), 0.05e-3);
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_LE(glm::length(drive.last().force), 0.5 + 1e-12);
  EXPECT_EQ(drive.to(mm(0, 0, -2.05)).event_count, 1);
}

TEST(Puncture, EveryLayersInterfaceTellsItsOwnAndTheNeedleComesOutOnTheFarSide) {
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields:
  skin: {box: {center: [0, 0, -1], size: [80, 80, 2]}}
  fat: {box: {center: [0, 0, -5], size: [80, 80, 6]}}
  muscle: {box: {center: [0, 0, -18], size: [80, 80, 20]}}
materials: {tissue: {stiffness: 1000 N/m}}
layers:
  - {name: skin, inside: skin, wall: tissue}
  - {name: fat, inside: fat, wall: tissue}
  - {name: muscle, inside: muscle, wall: tissue}
ports:
  - {name: pierce, between: [outside, skin], opens_at: 2.8 N}
  - {name: dermis, between: [skin, fat], opens_at: 0.9 N}
  - {name: fascia, between: [fat, muscle], opens_at: 1.6 N}
  - {name: far, between: [muscle, outside], opens_at: 1.2 N}
)"));
  struct Expected {
    RegionId from, to;
    double force, z;  // [N], [mm]
  };
  const std::vector<Expected> expected = {
      {0, 1, 2.8, 0}, {1, 2, 0.9, -2}, {2, 3, 1.6, -8}, {3, 0, 1.2, -28}};
  (void)drive.to(mm(0, 0, 5));
  std::vector<PortCrossing> found;
  for (double z = 5.0; z > -40.0; z -= 0.01) {
    (void)drive.to(mm(0, 0, z));
    for (const PortCrossing& crossing : drive.renderer().crossings()) found.push_back(crossing);
  }
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_EQ(drive.events(), "pierce dermis fascia far");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(found[i].from, expected[i].from);
    EXPECT_EQ(found[i].to, expected[i].to);
    EXPECT_NEAR(found[i].point.z, expected[i].z * 1e-3, 1e-9);
    EXPECT_GE(found[i].force, expected[i].force - 1e-9);
    EXPECT_LE(found[i].force, expected[i].force + kStiffness * kStep + 1e-9);
  }
}

}  // namespace
}  // namespace palpate::test
