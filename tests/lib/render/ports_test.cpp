// Ports felt through the renderers: one-way, ordered, and opened by force; absent walls; start and
// memory.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

class BothRenderers : public testing::TestWithParam<RendererKind> {};
INSTANTIATE_TEST_SUITE_P(Renderers, BothRenderers,
                         testing::Values(RendererKind::kPaper, RendererKind::kConstraint),
                         kindName);

TEST(ValveTube, LetsThroughOneWayAndRefusesTheOther) {
  Drive drive(sceneNamed("valve_tube"));
  (void)drive.walk(mm(-60, 0, 0));
  (void)drive.walk(mm(-20, 0, 0));
  EXPECT_EQ(drive.events(), "inlet");
  (void)drive.walk(mm(-60, 0, 0));
  EXPECT_EQ(drive.region(), "upstream") << "the inlet is one way";
  EXPECT_GT(drive.last().force.x, 800.0 * 0.019) << "pushed back in by the shut end";
  (void)drive.walk(mm(20, 0, 0));
  EXPECT_EQ(drive.events(), "valve");
  EXPECT_EQ(drive.region(), "downstream");
  (void)drive.walk(mm(-5, 0, 0));
  EXPECT_EQ(drive.region(), "downstream") << "the valve refuses the way back";
  EXPECT_EQ(drive.events(), "");
  (void)drive.to(mm(-5, 0, 0));  // at rest: behind a shut valve the drag is felt in full
  EXPECT_NEAR(drive.last().force.x, 800.0 * 5e-3 + 1.0 * 20e-3, 1e-6) << "wall and current";
  EXPECT_EQ(drive.events(), "");
  (void)drive.walk(mm(60, 0, 0));
  EXPECT_EQ(drive.events(), "outlet");
  (void)drive.walk(mm(30, 0, 0));
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_NEAR(drive.last().force.x, 800.0 * 10e-3, 1e-6);
}

/// Three segments in a row; each has a window to the outside, besides the ports between them.
std::string segments(const std::string& memory = {}) {
  return R"(
palpate: 1
length: mm
fields:
  bore: {cylinder: {center: [0, 0, 0], axis: [1, 0, 0], radius: 10, height: 200}}
  left: {half_space: {point: [0, 0, 0], normal: [-1, 0, 0]}}
  cut1: {half_space: {point: [20, 0, 0], normal: [-1, 0, 0]}}
  cut2: {half_space: {point: [40, 0, 0], normal: [-1, 0, 0]}}
  right: {half_space: {point: [60, 0, 0], normal: [1, 0, 0]}}
  upper: {half_space: {point: [0, 0, 0], normal: [0, 0, -1]}}
materials: {rubber: {stiffness: 1000 N/m}}
layers:
  - {name: one, inside: {intersection: [bore, left, right]}, wall: rubber}
  - {name: two, inside: {intersection: [bore, cut1, right]}, wall: rubber}
  - {name: three, inside: {intersection: [bore, cut2, right]}, wall: rubber}
ports:
  - {name: p1, between: [outside, one], on: left}
  - {name: p2, between: [one, two], on: cut1, after: [p1]}
  - {name: p3, between: [two, three], on: cut2, after: [p2]}
  - {name: w2, between: [outside, two], on: bore, where: upper, after: [p1]}
  - {name: w3, between: [outside, three], on: bore, where: upper, after: [p2]}
)" + memory;
}

TEST(CompositeCylinder, PortsInOrderAndInEveryWrongOrder) {
  const Vec3 start = mm(-10, 0, 0);
  const Vec3 above2 = mm(30, 0, 20);
  const Vec3 above3 = mm(50, 0, 20);
  const Vec3 in1 = mm(10, 0, 0);
  const Vec3 in2 = mm(30, 0, 0);
  const Vec3 in3 = mm(50, 0, 0);
  struct Row {
    const char* name;
    std::vector<Vec3> path;
    std::string region;
    std::string events;
  };
  for (const Row& row : {
           Row{"in order", {start, in1, in2, in3}, "three", "p1 p2 p3"},
           Row{"and back", {start, in1, in2, in3, in2, in1, start}, "outside", "p1 p2 p3 p3 p2 p1"},
           Row{"in one tick's straight line", {start, in3}, "three", "p1 p2 p3"},
           Row{"window of 2 first", {above2, in2}, "outside", ""},
           Row{"window of 3 first", {above3, in3}, "outside", ""},
           Row{"from the far end", {mm(80, 0, 0), in3}, "outside", ""},
           Row{"out by window 2", {start, in1, in2, above2}, "outside", "p1 p2 w2"},
           Row{"out by window 2, and in again: all is forgotten",
               {start, in1, in2, above2, in2},
               "outside",
               "p1 p2 w2"},
           Row{"out by window 3", {start, in3, above3}, "outside", "p1 p2 p3 w3"},
           Row{"back to 1, where 2 counts as not passed",
               {start, in1, in2, in1, in2, in3},
               "three",
               "p1 p2 p2 p2 p3"},
           Row{"1 has no window", {start, in1, mm(10, 0, 20)}, "one", "p1"},
           Row{"the window is only above", {start, in1, in2, mm(30, 0, -20)}, "two", "p1 p2"},
       }) {
    Drive drive(sceneOf(segments()));
    for (const Vec3& p : row.path) (void)drive.walk(p);
    EXPECT_EQ(drive.region(), row.region) << row.name;
    EXPECT_EQ(drive.events(), row.events) << row.name;
    EXPECT_EQ(drive.last().contact, drive.last().proxy != drive.hip()) << row.name;
  }
}

TEST(CompositeCylinder, AllInOneTick) {
  Drive drive(sceneOf(segments()));
  (void)drive.to(mm(-10, 0, 0));
  const TickResult& out = drive.to(mm(50, 0, 0));
  EXPECT_EQ(out.event_count, 3);
  EXPECT_EQ(drive.events(), "p1 p2 p3") << "in the order of the path";
  EXPECT_EQ(out.proxy, drive.hip());
  (void)drive.to(mm(-10, 0, 0));
  EXPECT_EQ(drive.events(), "p3 p2 p1");
}

TEST(Memory, KeptPortsOpenWindowsFromOutside) {
  for (const bool keep : {false, true}) {
    Drive drive(sceneOf(segments(keep ? "memory: keep\n" : "")));
    for (const Vec3& p :
         {mm(-10, 0, 0), mm(10, 0, 0), mm(-10, 0, 0), mm(-10, 0, 20), mm(30, 0, 20)})
      (void)drive.walk(p);
    (void)drive.events();
    (void)drive.walk(mm(30, 0, 0));
    EXPECT_EQ(drive.region(), keep ? "two" : "outside");
    EXPECT_EQ(drive.events(), keep ? "w2" : "");
  }
}

TEST(Memory, ARoomsDoorsOpenInOrderOnly) {
  // A ball with the doors of three rooms around it, all from outside: every order of visits,
  // against the rule.
  std::string text = "palpate: 1\nlength: mm\nmemory: keep\nlayers:\n";
  for (int i = 0; i < 3; ++i) {
    text += "  - {name: room" + std::to_string(i) + ", inside: {sphere: {center: [" +
            std::to_string(100 * i) + ", 0, 0], radius: 20}}}\n";
  }
  text += "ports:\n";
  for (int i = 0; i < 3; ++i) {
    text += "  - {name: d" + std::to_string(i) + ", between: [outside, room" + std::to_string(i) +
            "]" + (i > 0 ? ", after: [d" + std::to_string(i - 1) + "]" : "") + "}\n";
  }
  const ScenePtr scene = sceneOf(text);
  for (int code = 0; code < 81; ++code) {
    Drive drive(scene);
    (void)drive.walk(mm(0, 0, 50), 5e-3);
    bool passed[3] = {};
    for (int k = 0, rest = code; k < 4; ++k, rest /= 3) {
      const int room = rest % 3;
      (void)drive.walk(mm(100 * room, 0, 50), 5e-3);
      (void)drive.walk(mm(100 * room, 0, 0), 5e-3);
      const bool opens = room == 0 || passed[room - 1];
      ASSERT_EQ(drive.region(), opens ? "room" + std::to_string(room) : "outside") << code;
      passed[room] = passed[room] || opens;
      (void)drive.walk(mm(100 * room, 0, 50), 5e-3);
      ASSERT_EQ(drive.region(), "outside");
    }
  }
}

TEST(Cup, TheAbsentWallAtItsRimIsCrossedFreelyAndTheGlassIsNot) {
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields:
  outer: {sphere: {center: [0, 0, 0], radius: 42}}
  inner: {sphere: {center: [0, 0, 0], radius: 40}}
  brim: {half_space: {point: [0, 0, 10], normal: [0, 0, 1]}}
materials: {glass: {stiffness: 1000 N/m}, soft: {stiffness: 500 N/m}, tea: {viscosity: 2 N.s/m}}
layers:
  - {name: glass, inside: {difference: [{intersection: [outer, brim]}, inner]}, wall: glass}
  - {name: tea, inside: {intersection: [inner, brim]}, content: tea, wall: absent}
walls:
  - {between: [glass, tea], wall: soft, felt_from: tea}
  - {between: [glass, tea], wall: glass, felt_from: glass}
)"));
  (void)drive.walk(mm(0, 0, 30));
  (void)drive.walk(mm(0, 0, 0));
  EXPECT_EQ(drive.region(), "tea");
  EXPECT_EQ(drive.events(), "") << "an absent wall never counts as passed";
  EXPECT_TRUE(isNear(drive.walk(mm(0, 0, -41)).force, Vec3(0, 0, 500e-3), 1e-9))
      << "felt from the tea";
  EXPECT_EQ(drive.region(), "tea");
  (void)drive.walk(mm(0, 0, 30));
  EXPECT_EQ(drive.region(), "outside");
  // From outside, the outer glass and the flat ring on the rim are felt.
  (void)drive.walk(mm(60, 0, 30));
  (void)drive.walk(mm(60, 0, 0));
  EXPECT_TRUE(isNear(drive.walk(mm(41, 0, 0)).force, Vec3(1, 0, 0), 1e-9));
  EXPECT_EQ(drive.region(), "outside");
  (void)drive.walk(mm(60, 0, 0));
  const double ring = 0.5 * (std::sqrt(42.0 * 42 - 100) + std::sqrt(40.0 * 40 - 100));
  (void)drive.walk(mm(ring, 0, 30));
  EXPECT_TRUE(isNear(drive.walk(mm(ring, 0, 9.5)).force, Vec3(0, 0, 0.5), 1e-9));
  // Sliding inward off the ring the proxy falls into the tea.
  (void)drive.walk(mm(ring - 4, 0, 9.5), 0.05e-3);
  EXPECT_EQ(drive.region(), "tea");
}

constexpr const char* kSkin = R"(
palpate: 1
length: mm
materials: {skin: {stiffness: 1000 N/m, friction: {static: 0.3}}}
layers: [{name: body, inside: {sphere: {center: [0, 0, 0], radius: 40}}, wall: skin}]
ports: [{name: cut, between: [outside, body], opens_at: 2 N, back: 0.5 N}]
)";

/// The probe goes into a box through the absent wall at x = 0 and out through a port at x = 10 mm,
/// in steps that end near both.
TEST_P(BothRenderers, APassingHasItsPlaceOnTheWallAndNotAtTheHand) {
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields:
  front: {half_space: {point: [0, 0, 0], normal: [-1, 0, 0]}}
  back: {half_space: {point: [10, 0, 0], normal: [1, 0, 0]}}
materials: {glass: {stiffness: 1000 N/m}}
layers:
  - {name: first, inside: {intersection: [front, back]}, wall: absent}
  - {name: second, inside: {half_space: {point: [10, 0, 0], normal: [-1, 0, 0]}}, wall: glass}
ports:
  - {name: door, between: [first, second]}
)"),
              GetParam());
  const auto passes = [&](double from, double to) {
    (void)drive.to(mm(from, 0, 0));
    (void)drive.to(mm(to, 0, 0));
    const std::span<const RegionEntry> entries = drive.renderer().entries();
    return entries.size() == 1 ? entries[0].point.x * 1e3 : std::nan("");
  };
  // Bisection of 0.4 mm, and the proxy's rest on a wall, both end within 1e-9 m.
  EXPECT_NEAR(passes(-0.3, 0.1), 0.0, 1e-6);
  EXPECT_NEAR(passes(9.9, 10.3), 10.0, 1e-6);
  EXPECT_NEAR(passes(10.1, 9.7), 10.0, 1e-6) << "on the way back";
  EXPECT_NEAR(passes(0.3, -0.1), 0.0, 1e-6);
}

TEST(OpeningForce, OpensAtKTimesDepthAndNotBefore) {
  for (const bool enough : {false, true}) {
    Drive drive(sceneOf(kSkin));
    (void)drive.to(mm(0, 0, 50));
    const double needed = 2.0 / 1000.0;
    const double depth = needed * (1.0 + (enough ? 1e-9 : -1e-9));
    (void)drive.walk(Vec3(0, 0, 0.04 - depth), 0.1e-3);
    EXPECT_EQ(drive.events(), enough ? "cut" : "");
    EXPECT_EQ(drive.region(), enough ? "body" : "outside");
    if (enough) {
      EXPECT_EQ(drive.last().force, Vec3(0.0));
      // On the way back the port needs a force of its own.
      (void)drive.walk(Vec3(0, 0, 0.04 + 0.49e-3), 0.05e-3);
      EXPECT_EQ(drive.region(), "body");
      EXPECT_NEAR(drive.last().force.z, -0.49, 1e-9);
      (void)drive.walk(Vec3(0, 0, 0.04 + 0.51e-3), 0.01e-3);
      EXPECT_EQ(drive.region(), "outside");
    } else {
      EXPECT_NEAR(drive.last().force.z, 2.0, 1e-6);
    }
  }
}

TEST(OpeningForce, DampingAndFrictionDoNotOpen) {
  std::string text = kSkin;
  text.replace(text.find("1000 N/m,"), 9, "1000 N/m, damping: 50 N.s/m,");
  Drive drive(sceneOf(text));
  (void)drive.to(mm(0, 0, 50));
  (void)drive.to(mm(0, 0, 38.5));  // 11.5 m/s inward: 575 N of damping, 1.5 N of spring
  EXPECT_EQ(drive.region(), "outside");
}

TEST(OpeningForce, AFastStrokeAlongTheSkinDoesNotOpenWhatItNeverPresses) {
  // 1.5 mm deep all the way: 1.5 N at any speed. Only a tangent plane left from the last tick would
  // be pressed harder.
  for (const double step : {0.02, 0.1, 0.3}) {
    Drive drive(sceneOf(kSkin));
    (void)drive.walk(mm(50, 0, 0));
    (void)drive.walk(mm(38.5, 0, 0));
    for (double angle = 0.0; angle < 6.0; angle += step) {
      (void)drive.to(0.0385 * Vec3(std::cos(angle), std::sin(angle), 0));
      ASSERT_EQ(drive.region(), "outside") << step << " " << angle;
    }
  }
}

TEST(OpeningForce, AnObliqueLandingDoesNotOpenWhatItNeverPresses) {
  // The hand jumps in one tick from outside to 1.5 mm below the top, on a path that meets the ball
  // far down its side.
  Drive drive(sceneOf(kSkin));
  (void)drive.to(mm(45, 0, 10));
  (void)drive.to(mm(0, 0, 38.5));
  EXPECT_EQ(drive.region(), "outside");
}

TEST_P(BothRenderers, StartsInsideWhereTheSceneSaysSo) {
  Drive drive(sceneOf(containerText("start: {region: liquid}\n")), GetParam());
  (void)drive.to(mm(0, 0, 0));
  EXPECT_EQ(drive.region(), "liquid");
  EXPECT_EQ(drive.events(), "");
  EXPECT_TRUE(isNear(drive.walk(mm(0, 0, -41)).force, Vec3(0, 0, 1.5), 3e-3))
      << "the wall from within";
  (void)drive.walk(mm(0, 0, 30));
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_EQ(drive.events(), "mouth");
}

TEST(Start, AHipElsewhereGetsANearPointOfTheRegion) {
  for (const Vec3& hip : {mm(60, 0, 0), mm(0, 0, -45), mm(10, 10, 30), mm(500, -300, 20)}) {
    Drive drive(sceneOf(containerText("start: {region: liquid}\n")));
    const TickResult& out = drive.to(hip);
    EXPECT_TRUE(isFinite(out.force));
    // At once or after a few ticks at rest the proxy is the closest point of the liquid, reached
    // through the mouth if that is open.
    for (int i = 0; i < 20; ++i) (void)drive.to(hip);
    if (hip.z > 0.015 && glm::length(hip) < 0.05) {
      EXPECT_EQ(drive.region(), "outside");
    } else if (hip.z < 0.01) {
      EXPECT_EQ(drive.region(), "liquid");
      EXPECT_TRUE(isNear(out.proxy, 0.04 * glm::normalize(hip), 1e-9));
    }
  }
  // And the opposite: a HIP that begins inside, while the scene starts outside.
  Drive drive(sceneOf(containerText()));
  const TickResult& out = drive.to(mm(0, 0, -35));
  EXPECT_EQ(out.region, kOutside);
  EXPECT_TRUE(isNear(out.proxy, mm(0, 0, -40), 1e-9));
}

TEST(Start, ResetIsAFreshStart) {
  Drive drive(sceneOf(containerText()));
  (void)drive.walk(mm(0, 0, 30));
  (void)drive.walk(mm(0, 0, 0));
  ASSERT_EQ(drive.region(), "liquid");
  drive.renderer().reset();
  EXPECT_EQ(drive.to(mm(60, 0, 0)).region, kOutside);
  EXPECT_EQ(drive.last().force, Vec3(0.0));
  EXPECT_EQ(drive.last().event_count, 0);
}

TEST(Sheets, NestedFacesThatCoincideAreCrossedInOneStepIntoTheRightRegion) {
  // An inner box that shares its top face, right face and an edge with the outer one; both have a
  // port on top.
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields:
  shell: {box: {center: [0, 0, 0], size: [40, 40, 40]}}
  core: {box: {center: [5, 0, 5], size: [30, 20, 30]}}
layers:
  - {name: shell, inside: shell}
  - {name: core, inside: core}
ports:
  - {name: direct, between: [outside, core]}
  - {name: side, between: [outside, shell]}
)"));
  (void)drive.walk(mm(5, 0, 40));
  (void)drive.walk(mm(5, 0, 10));
  EXPECT_EQ(drive.region(), "core");
  EXPECT_EQ(drive.events(), "direct") << "one step, one event, and never in between";
  (void)drive.walk(mm(5, 0, -15));
  EXPECT_EQ(drive.region(), "core") << "no port leads from core to shell";
  EXPECT_NEAR(drive.last().force.z, 1000 * 5e-3, 1e-9);
  (void)drive.walk(mm(40, 0, 5));
  EXPECT_EQ(drive.region(), "outside");
  EXPECT_EQ(drive.events(), "direct");
  (void)drive.walk(mm(40, 15, 5));
  (void)drive.walk(mm(10, 15, 5));
  EXPECT_EQ(drive.region(), "shell");
  EXPECT_EQ(drive.events(), "side");
}

}  // namespace
}  // namespace palpate::test
