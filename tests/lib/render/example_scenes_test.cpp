// The example scenes of shapes and sheets, felt: the objects in them hold the probe where it is.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

struct Thing {
  const char* layer;
  double x, y;  ///< [mm] place where it is pressed from above
};

// [m] Height at which `layer` begins when (x, y) is approached from above; the line must begin
// outside it.
double topOf(const Scene& scene, const Thing& thing) {
  const RegionId region = scene.regionNamed(thing.layer);
  double z = 70.0;
  while (z > -10.0 && scene.regionAt(mm(thing.x, thing.y, z)) != region) z -= 0.05;
  double above = z + 0.05;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (z + above);
    (scene.regionAt(mm(thing.x, thing.y, middle)) == region ? z : above) = middle;
  }
  return 1e-3 * z;
}

TEST(ExampleScenes, EveryThingOnTheTableIsFelt) {
  const ScenePtr scene = sceneNamed("fields");
  const std::vector<Thing> things = {
      {"table", -20, 0},       {"ring", -88, 31}, {"spike", -47, 32},        {"heart", 6, 30},
      {"drops", 58, 33},       {"pill", 104, 30}, {"hourglass", -103, -29},  {"knob", -48, -29},
      {"egg cup", 0.5, -46.5}, {"star", 64, -30}, {"little heart", 109, -31}};
  ASSERT_EQ(things.size() + 1, scene->regions().size());
  for (const Thing& thing : things) {
    SCOPED_TRACE(thing.layer);
    const double top = topOf(*scene, thing);
    ASSERT_GT(top, -1e-3);
    Drive hand(scene);
    (void)hand.walk({1e-3 * thing.x, 1e-3 * thing.y, top + 0.005});
    EXPECT_EQ(hand.last().force, Vec3(0.0));
    const TickResult pressed = hand.walk({1e-3 * thing.x, 1e-3 * thing.y, top - 0.001}, 0.05e-3);
    EXPECT_TRUE(pressed.contact);
    EXPECT_EQ(hand.region(), "outside");
    // The force is upward, and at most that of its spring at this depth, or twice that where two
    // walls meet.
    const Region& region = scene->regions()[scene->regionNamed(thing.layer)];
    const Material& wall = scene->materials()[static_cast<std::size_t>(region.wall)];
    const double stiffness = wall.stiffness.at(pressed.proxy);
    EXPECT_GT(pressed.force.z, 0.02 * stiffness * 0.001);
    EXPECT_LT(glm::length(pressed.force), 2.0 * stiffness * 0.001);
    // The proxy is on the surface: within a hundredth of a micrometer, or the corresponding share
    // of the feature size.
    const FieldSample s = region.field->sample(pressed.proxy);
    EXPECT_LT(std::fabs(s.value) / std::max(glm::length(s.gradient), 1e-9), 1e-7);
    const TickResult gone = hand.walk({1e-3 * thing.x, 1e-3 * thing.y, top + 0.005});
    EXPECT_FALSE(gone.contact);
  }
}

// The gyroid divides the block into two mazes: the proxy goes deep into one, and never into the
// foam or, while it stays in the block, into the other maze.
TEST(ExampleScenes, TheSpongesMazesAreApart) {
  const ScenePtr scene = sceneNamed("sponge");
  const FieldPtr foam = scene->regions()[scene->regionNamed("sponge")].field;
  const FieldPtr side = gyroid(Vec3(0.0), 0.024);
  const FieldPtr block = box(mm(0, 0, -4), mm(36, 36, 36));
  Drive hand(scene);
  (void)hand.walk(mm(-6, 0, 40));
  (void)hand.walk(mm(-6, 0, 16));
  EXPECT_EQ(hand.region(), "jelly");
  EXPECT_EQ(hand.events(), "top");
  (void)hand.walk(mm(-6, 0, -4));
  EXPECT_FALSE(hand.last().contact);
  int contacts = 0;
  int changes = 0;
  int ticks_in_block = 0;
  bool last_side = false;
  bool was_in_block = false;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.01 * i;
    const TickResult tick = hand.to(
        mm(13 * std::sin(1.1 * t), 13 * std::sin(0.7 * t + 1), -4 + 13 * std::sin(1.3 * t + 2)));
    ASSERT_EQ(hand.region(), "jelly");
    if (tick.contact) ++contacts;
    ASSERT_GT(foam->value(tick.proxy), -1e-9) << i;
    // Well inside: near a face of the block the proxy may go around outside in one tick.
    const bool in_block = block->value(tick.proxy) < -0.5e-3;
    const bool on_side = side->value(tick.proxy) > 0.0;
    if (in_block) ++ticks_in_block;
    if (in_block && was_in_block && on_side != last_side) ++changes;
    last_side = on_side;
    was_in_block = in_block;
  }
  EXPECT_EQ(changes, 0);
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(ticks_in_block, 1000);
}

TEST(ExampleScenes, TheFlagHoldsInAirAndWater) {
  Drive hand(sceneNamed("flag"));
  (void)hand.walk(mm(10, 0, 15));
  (void)hand.walk(mm(-1, 0, 15));
  EXPECT_TRUE(hand.last().contact);
  EXPECT_EQ(hand.region(), "outside");
  EXPECT_GT(hand.last().force.x, 0.4);
  // The hand goes down along the flag into the water, still in front of the flag.
  (void)hand.walk(mm(-1, 0, -15));
  EXPECT_EQ(hand.region(), "water");
  EXPECT_EQ(hand.events(), "surface");
  EXPECT_TRUE(hand.last().contact);
  EXPECT_GT(hand.last().force.x, 0.4);
  EXPECT_GE(hand.last().proxy.x, -1e-8);
  // Below the flag's hem the way is free, and behind it the other side is felt.
  (void)hand.walk(mm(-1, 0, -30));
  EXPECT_FALSE(hand.last().contact);
  (void)hand.walk(mm(-10, 0, -15));
  (void)hand.walk(mm(1, 0, -15));
  EXPECT_TRUE(hand.last().contact);
  EXPECT_LT(hand.last().force.x, -0.4);
  // Next, the membrane over the bottom.
  (void)hand.walk(mm(-10, 0, -30));
  (void)hand.walk(mm(-10, 0, -50));
  EXPECT_TRUE(hand.last().contact);
  EXPECT_GT(hand.last().force.z, 0.3);
}

}  // namespace
}  // namespace palpate::test
