// Sheets of a scene file: felt from both sides, never passed through, with free space beyond their
// edge; and the paper's renderer, which refuses them.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "lib/scene/problems.h"
#include "palpate/interior/port_machine.h"

namespace palpate::test {
namespace {

// A disc of 30 mm without thickness in the plane z = 0, of 800 N/m, in free space.
const std::string kDisc = R"(
palpate: 1
length: mm
materials: {foil: {stiffness: 800 N/m}}
sheets:
  - name: disc
    on: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
    where: {cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 30, height: 20}}
    wall: foil
)";

TEST(SceneSheets, AreReadAndCompiled) {
  const SceneDescription described = parseScene(kDisc, "test.yaml");
  ASSERT_EQ(described.sheets.size(), 1U);
  EXPECT_EQ(described.sheets[0].name, "disc");
  EXPECT_EQ(described.sheets[0].material, "foil");
  EXPECT_EQ(described.sheets[0].place.line, 6);
  const ScenePtr scene = compile(described);
  ASSERT_EQ(scene->passages().sheets().size(), 1U);
  const Sheet& sheet = scene->passages().sheets()[0];
  EXPECT_EQ(sheet.leaves.size(), 1U);
  EXPECT_GE(sheet.mask, 0);
  EXPECT_EQ(scene->materials()[static_cast<std::size_t>(sheet.material)].name, "foil");
}

TEST(SceneSheets, WithoutAWallAreTheDefaultWall) {
  const ScenePtr scene = sceneOf(
      "palpate: 1\nlength: mm\nsheets: [{name: s, on: {sphere: {center: [0, 0, 0], radius: 9}}}]");
  const Sheet& sheet = scene->passages().sheets()[0];
  EXPECT_EQ(sheet.mask, -1);
  EXPECT_EQ(scene->materials()[static_cast<std::size_t>(sheet.material)].stiffness, 1000.0);
}

TEST(SceneSheets, AreFeltFromBothSides) {
  for (const double side : {1.0, -1.0}) {
    Drive hand(sceneOf(kDisc));
    (void)hand.walk(mm(3, 4, 10 * side));
    const TickResult pressed = hand.walk(mm(3, 4, -2 * side));
    EXPECT_TRUE(pressed.contact);
    // 800 N/m, 2 mm deep; flat, so exact except for rounding.
    EXPECT_TRUE(isNear(pressed.force, Vec3(0, 0, 1.6 * side), 1e-9));
    EXPECT_EQ(hand.region(), "outside");
  }
}

TEST(SceneSheets, HoldAtAnySpeed) {
  // Jumps straight through it, at many phases of the step.
  for (int phase = 0; phase < 200; ++phase) {
    Drive hand(sceneOf(kDisc));
    const double step = 20.0;  // [mm] in a tick: 20 m/s
    double z = 50.0 + step * phase / 200.0;
    for (; z > -60.0; z -= step) (void)hand.to(mm(1 + 0.01 * z, 2, z));
    EXPECT_TRUE(hand.last().contact) << phase;
    EXPECT_GE(hand.last().proxy.z, -1e-6) << phase;
  }
}

TEST(SceneSheets, LetGoPastTheirEdge) {
  Drive hand(sceneOf(kDisc));
  (void)hand.walk(mm(0, 0, 10));
  (void)hand.walk(mm(0, 0, -2));
  (void)hand.walk(mm(29, 0, -2));
  EXPECT_TRUE(hand.last().contact);
  EXPECT_NEAR(hand.last().proxy.z, 0.0, 1e-9);
  const TickResult beyond = hand.walk(mm(33, 0, -2));
  EXPECT_FALSE(beyond.contact);
  EXPECT_TRUE(isNear(beyond.proxy, mm(33, 0, -2), 1e-9));
  // And from below, against the other side.
  const TickResult below = hand.walk(mm(0, 0, 2));
  EXPECT_TRUE(below.contact);
  EXPECT_TRUE(isNear(below.force, Vec3(0, 0, -1.6), 1e-9));
}

TEST(SceneSheets, AreRefusedByThePapersRenderer) {
  const Problem problem =
      problemOf([] { (void)makeRenderer(sceneOf(kDisc), {.kind = RendererKind::kPaper}); });
  EXPECT_EQ(problem.code, "render.paper_sheet");
  EXPECT_NE(problem.message.find("'disc'"), std::string::npos);
}

TEST(SceneTextures, AddTheirHeightOfForce) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials: {file: {stiffness: 1000 N/m, texture: {amplitude: 0.3, wavelength: 8}}}
layers: [{name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: file}]
)");
  const Material& file = scene->materials()[0];
  EXPECT_EQ(file.texture.amplitude, 0.0003);
  EXPECT_EQ(file.texture.wavelength, 0.008);
  Drive hand(scene);
  (void)hand.walk(mm(0, 0, 5));
  // A crest in x and y: the sine is 1 at a quarter of the wavelength; z is 0. The proxy stands some
  // nanometers above the plane, and the wave in z adds K 2 pi amplitude / wavelength / 3 of that.
  EXPECT_NEAR(hand.walk(mm(2, 2, -2)).force.z, 1000 * (0.002 + 0.0003 * 2 / 3), 1e-7);
  EXPECT_NEAR(hand.walk(mm(6, 6, -2)).force.z, 1000 * (0.002 - 0.0003 * 2 / 3), 1e-7);
  // Under a light press, a crest adds at most half of the depth: 0.05 mm to the 0.1 mm here.
  EXPECT_NEAR(hand.walk(mm(2, 2, -0.1)).force.z, 1000 * 0.00015, 1e-9);
}

}  // namespace
}  // namespace palpate::test
