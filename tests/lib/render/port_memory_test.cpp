// The renderers' memory of ports: many laps of a ring, ports that lead back, counts of passings,
// absent walls that clear the memory, and ports in sheets.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

class PortMemory : public testing::TestWithParam<RendererKind> {};
INSTANTIATE_TEST_SUITE_P(Renderers, PortMemory,
                         testing::Values(RendererKind::kPaper, RendererKind::kConstraint),
                         kindName);

/// Three chambers around the z axis, with walls between them at y = 0 (x > 0) and at x = 0: a is
/// where x > 0, y > 0; b where x < 0; c where x > 0, y < 0. From outside, a is entered from above;
/// `vault` is below a.
std::string ring(const std::string& ports) {
  return R"(
palpate: 1
length: mm
fields:
  hull: {box: {center: [0, 0, 0], size: [80, 80, 40]}}
  cellar: {box: {center: [0, 0, -25], size: [80, 80, 30]}}
  left: {half_space: {point: [0, 0, 0], normal: [1, 0, 0]}}
  front: {half_space: {point: [0, 0, 0], normal: [0, 1, 0]}}
  roof: {half_space: {point: [0, 0, 10], normal: [0, 0, 1]}}
layers:
  - {name: a, inside: {intersection: [hull, roof, {complement: left}, {complement: front}]}}
  - {name: b, inside: {intersection: [hull, left]}}
  - {name: c, inside: {intersection: [hull, {complement: left}, front]}}
  - {name: vault, inside: cellar}
ports:
  - {name: in, between: [outside, a], on: roof}
)" + ports;
}

const Vec3 kAbove = mm(20, 20, 30);
const Vec3 kA = mm(20, 20, 0);
const Vec3 kB = mm(-20, 0, 0);
const Vec3 kC = mm(20, -20, 0);
constexpr double kStep = 5e-3;

/// Goes to b, c and back to a, through the middles of the walls.
void lap(Drive& drive) {
  (void)drive.walk(mm(-20, 20, 0), kStep);
  (void)drive.walk(mm(-20, -20, 0), kStep);
  (void)drive.walk(kC, kStep);
  (void)drive.walk(kA, kStep);
}

TEST_P(PortMemory, AfterThirtyLapsOfARingTheFirstPortStillCounts) {
  Drive drive(sceneOf(ring(R"(
  - {name: ab, between: [a, b], after: [in]}
  - {name: bc, between: [b, c], after: [in]}
  - {name: ca, between: [c, a], after: [in]}
)")),
              GetParam());
  (void)drive.walk(kAbove);
  (void)drive.walk(kA);
  EXPECT_EQ(drive.events(), "in");
  for (int i = 0; i < 30; ++i) {
    lap(drive);
    ASSERT_EQ(drive.events(), "ab bc ca") << "lap " << i;
    ASSERT_EQ(drive.region(), "a");
  }
}

TEST_P(PortMemory, AfterMayNameAPortThatLeadsBack) {
  Drive drive(sceneOf(ring(R"(
  - {name: ab, between: [a, b], direction: in}
  - {name: ba, between: [a, b], direction: out}
  - {name: bc, between: [b, c], after: [ba]}
)")),
              GetParam());
  (void)drive.walk(kAbove);
  (void)drive.walk(kA);
  (void)drive.walk(mm(-20, 20, 0));
  (void)drive.walk(mm(-20, -20, 0));
  (void)drive.walk(mm(5, -20, 0));
  EXPECT_EQ(drive.region(), "b") << "ba was not passed";
  EXPECT_TRUE(drive.last().contact);
  (void)drive.walk(mm(-20, -20, 0));
  (void)drive.walk(mm(-20, 20, 0));
  (void)drive.walk(kA);
  (void)drive.walk(mm(-20, 20, 0));
  (void)drive.walk(mm(-20, -20, 0));
  (void)drive.walk(kC);
  EXPECT_EQ(drive.events(), "in ab ba ab bc");
  EXPECT_EQ(drive.region(), "c");
}

TEST_P(PortMemory, AtLeastSoManyTimes) {
  Drive drive(sceneOf(ring(R"(
  - {name: ab, between: [a, b]}
  - {name: bc, between: [b, c]}
  - {name: ca, between: [c, a]}
  - {name: trap, between: [a, vault], after: [{port: ca, times: 3}]}
)")),
              GetParam());
  (void)drive.walk(kAbove);
  (void)drive.walk(kA);
  for (int laps = 0; laps < 5; ++laps) {
    (void)drive.walk(mm(20, 20, -20));
    EXPECT_EQ(drive.region(), laps >= 3 ? "vault" : "a") << laps;
    (void)drive.walk(kA);
    lap(drive);
  }
}

TEST_P(PortMemory, AnAbsentWallToOutsideClearsWhatWasPassed) {
  // The probe goes into a by its port, and out where b has no wall: after that, the port that
  // requires the first one is shut, from outside too.
  for (const bool keep : {false, true}) {
    Drive drive(sceneOf(ring(R"(
  - {name: ab, between: [a, b]}
  - {name: cellar, between: [outside, vault], after: [in]}
walls:
  - {between: [outside, b], wall: absent}
)") + (keep ? "memory: keep\n" : "")),
                GetParam());
    (void)drive.walk(kAbove);
    (void)drive.walk(kA);
    (void)drive.walk(mm(-20, 20, 0));
    EXPECT_EQ(drive.events(), "in ab");
    (void)drive.walk(mm(-60, 20, 0));
    EXPECT_EQ(drive.region(), "outside");
    EXPECT_EQ(drive.events(), "");
    (void)drive.walk(mm(-60, 20, -20));
    (void)drive.walk(mm(-20, 20, -20));
    EXPECT_EQ(drive.region(), keep ? "vault" : "outside");
    EXPECT_EQ(drive.events(), keep ? "cellar" : "");
  }
}

/// A plate at z = 0 in air, with an opening in the middle; a box beneath it.
std::string plate(const std::string& port, const std::string& more = {}) {
  return R"(
palpate: 1
length: mm
fields:
  level: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
  disc: {cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 40, height: 20}}
  middle: {cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 10, height: 20}}
layers: [{name: box, inside: {box: {center: [0, 0, -40], size: [20, 20, 20]}}}]
sheets: [{name: plate, on: level, where: disc}]
ports:
  - {name: slit, sheet: plate, where: middle)" +
         port + "}\n" + more;
}

TEST(SheetPorts, OpenTheSheetWhereTheyAreAndNowhereElse) {
  Drive drive(sceneOf(plate("")));
  (void)drive.walk(mm(20, 0, 10));
  (void)drive.walk(mm(20, 0, -2));
  EXPECT_TRUE(isNear(drive.last().force, {0, 0, 2.0}, 1e-6)) << "beside the slit";
  EXPECT_EQ(drive.events(), "");
  (void)drive.walk(mm(20, 0, 10));
  (void)drive.walk(mm(3, 0, 10));
  (void)drive.walk(mm(3, 0, -10));
  EXPECT_EQ(drive.last().force, Vec3(0.0));
  EXPECT_EQ(drive.events(), "slit");
  EXPECT_EQ(drive.region(), "outside");
  (void)drive.walk(mm(3, 0, 10));
  EXPECT_EQ(drive.events(), "slit");
}

TEST(SheetPorts, OneWayAndByForce) {
  Drive valve(sceneOf(plate(", direction: in")));
  (void)valve.walk(mm(0, 0, 10));
  (void)valve.walk(mm(0, 0, -10));
  EXPECT_EQ(valve.events(), "slit") << "in is into what the sheet is the surface of";
  (void)valve.walk(mm(0, 0, 3));
  EXPECT_EQ(valve.events(), "");
  EXPECT_TRUE(isNear(valve.last().force, {0, 0, -3.0}, 1e-6));

  Drive skin(sceneOf(plate(", opens_at: 4 N, back: 2 N")));
  (void)skin.walk(mm(0, 0, 10));
  (void)skin.walk(mm(0, 0, -3.9), 0.1e-3);
  EXPECT_EQ(skin.events(), "");
  EXPECT_NEAR(skin.last().force.z, 3.9, 1e-6);
  (void)skin.walk(mm(0, 0, -4.1), 0.1e-3);
  EXPECT_EQ(skin.events(), "slit");
  EXPECT_EQ(skin.last().force, Vec3(0.0));
  (void)skin.walk(mm(0, 0, 1.9), 0.1e-3);
  EXPECT_NEAR(skin.last().force.z, -1.9, 1e-6);
  (void)skin.walk(mm(0, 0, 2.1), 0.1e-3);
  EXPECT_EQ(skin.events(), "slit");
}

TEST(SheetPorts, CountForWhatComesAfterThemAndBackTakesThemBack) {
  const ScenePtr scene =
      sceneOf(plate("", "  - {name: lid, between: [outside, box], after: [slit]}\n"));
  EXPECT_EQ(scene->regions()[1].reach, Reach::kYes);
  for (const bool through : {true, false}) {
    Drive drive(scene);
    (void)drive.walk(mm(0, 0, 10));
    if (through) {
      (void)drive.walk(mm(0, 0, -20));
    } else {  // around its edge
      (void)drive.walk(mm(50, 0, 10));
      (void)drive.walk(mm(50, 0, -20));
      (void)drive.walk(mm(0, 0, -20));
    }
    (void)drive.walk(mm(0, 0, -40));
    EXPECT_EQ(drive.events(), through ? "slit lid" : "");
    EXPECT_EQ(drive.region(), through ? "box" : "outside");
  }
  Drive drive(scene);
  for (const Vec3& p : {mm(0, 0, 10), mm(0, 0, -20), mm(0, 0, 10), mm(50, 0, 10), mm(50, 0, -20),
                        mm(0, 0, -20), mm(0, 0, -40)}) {
    (void)drive.walk(p);
  }
  EXPECT_EQ(drive.events(), "slit slit") << "there and back is not passed";
}

TEST(SheetPorts, ASheetThatIsNotThereAndKeysThatDoNotGoTogetherAreErrors) {
  const auto code = [](const std::string& text) {
    try {
      (void)sceneOf(text);
    } catch (const Error& error) {
      return error.problem().code;
    }
    return std::string();
  };
  EXPECT_EQ(code(plate(", between: [outside, box]")), "scene.one_of");
  EXPECT_EQ(code(plate(", on: level")), "scene.one_of");
  std::string text = plate("");
  text.replace(text.find("sheet: plate"), 12, "sheet: plaet");
  EXPECT_EQ(code(text), "scene.unknown_sheet");
  text = plate(", after: [{port: slit, times: 2}]");
  EXPECT_EQ(code(text), "scene.cycle");
  const std::string lid = "  - {name: lid, between: [outside, box], after: [";
  EXPECT_EQ(code(plate("", lid + "{port: slit, times: 0}]}\n")), "scene.range");
  EXPECT_EQ(code(plate("", lid + "{port: slit, times: 1.5}]}\n")), "scene.range");
  EXPECT_EQ(code(plate("", lid + "{port: slot}]}\n")), "scene.unknown_port");
  EXPECT_EQ(code(plate("", lid + "{port: slit, time: 2}]}\n")), "scene.unknown_key");
  EXPECT_EQ(code(plate("", lid + "slit, {port: slit, times: 2}]}\n")), "scene.duplicate_name");
}

}  // namespace
}  // namespace palpate::test
