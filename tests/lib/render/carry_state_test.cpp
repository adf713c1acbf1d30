// A probe in a scene that is edited while it is there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lib/render/drive.h"
#include "palpate/render/haptic_renderer.h"
#include "support/field_contract.h"
#include "support/stored_trace.h"

namespace palpate::test {
namespace {

/// A ball in a ball; the inner one admits only a probe that came through the skin.
std::string ballsText(const std::string& layers_before, const std::string& ports_before,
                      const std::string& shell = "shell", double radius = 40.0) {
  return R"(
palpate: 1
length: mm
materials:
  glass: {stiffness: 1500 N/m, friction: {static: 0.3, kinetic: 0.2}, maxwell: {stiffness: 500 N/m, time: 0.1 s}}
  gel: {viscosity: 2 N.s/m}
layers:
)" + layers_before +
         "  - {name: " + shell +
         ", inside: {sphere: {center: [0, 0, 0], radius: " + std::to_string(radius) +
         R"(}}, content: gel, wall: glass}
  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 15}}, wall: glass}
ports:
)" + ports_before +
         "  - {name: skin, between: [outside, " + shell +
         "], opens_at: 2 N, hole: {radius: 3, reopens_at: 0.5 N}}\n"
         "  - {name: gate, between: [" +
         shell + ", core], after: [skin]}\n";
}

/// [m] A hand's path through the skin and the gate to the middle, out through the hole and in
/// again.
std::vector<Vec3> thereAndBack() {
  std::vector<Vec3> out;
  for (int i = 0; i <= 2000; ++i) {
    const double s = i / 2000.0;
    const double z = s < 0.4    ? 50.0 - 110.0 * s
                     : s < 0.75 ? 6.0 + 120.0 * (s - 0.4)
                                : 48.0 - 150.0 * (s - 0.75);
    out.push_back(mm(1.0 + 2.0 * s, -1.0, z));
  }
  return out;
}

TEST(CarriedState, GoesOnAsIfTheEditedSceneHadBeenThereFromTheStart) {
  const ScenePtr before = sceneOf(ballsText("", ""));
  // New layers, ports and so on come first, so that all numbers of regions, leaves, ports and
  // materials change.
  std::string text = ballsText(
      "  - {name: wart, inside: {box: {center: [-60, 0, 0], size: [4, 4, 4]}}, wall: horn}\n",
      "  - {name: pore, between: [outside, wart]}\n");
  text.insert(text.find("  glass:"), "  horn: {stiffness: 300 N/m}\n");
  const ScenePtr after = sceneOf(text);
  const std::vector<Vec3> path = thereAndBack();
  int pressed = 0;
  int passed = 0;
  for (std::size_t edit = 50; edit < path.size(); edit += 7) {
    Drive old(before);
    Drive wanted(after);
    Drive edited(after);
    for (std::size_t i = 0; i < edit; ++i) {
      (void)old.to(path[i]);
      (void)wanted.to(path[i]);
      (void)edited.to(path[0]);
    }
    const CarriedState carried =
        carryState(old.renderer().state(), RendererKind::kConstraint, *before, *after);
    ASSERT_TRUE(carried.goes_on) << edit;
    if (old.last().contact) ++pressed;
    EXPECT_TRUE(carried.lost.empty());
    ASSERT_TRUE(edited.renderer().setState(carried.state));
    for (std::size_t i = edit; i < path.size(); ++i) {
      const Vec3 velocity = (path[i] - path[i - 1]) / Drive::kTick;
      const TickResult now = edited.renderer().update({path[i], velocity});
      const TickResult then = wanted.to(path[i]);
      ASSERT_EQ(now.region, then.region) << "edited at " << edit << ", tick " << i;
      // A carried state may differ by rounding: 1.5 kN/m times the distance between two roundings
      // of the same wall.
      ASSERT_TRUE(isNear(now.force, then.force, 1e-8)) << "edited at " << edit << ", tick " << i;
      ASSERT_EQ(now.event_count, then.event_count) << "edited at " << edit << ", tick " << i;
      passed += now.event_count;
    }
  }
  EXPECT_GT(pressed, 0);
  EXPECT_GT(passed, 20);
}

TEST(CarriedState, WhatIsGoneIsToldAndTheProbeStartsAnewWithARamp) {
  const ScenePtr before = sceneOf(ballsText("", ""));
  RendererSettings settings;
  settings.limits.ramp = 0.05;
  Drive old(before, RendererKind::kConstraint, settings);
  (void)old.walk(mm(0, 0, 50));
  (void)old.walk(mm(0, 0, 25));
  ASSERT_EQ(old.region(), "shell");
  const auto lost_in = [&](const std::string& text) {
    const ScenePtr after = sceneOf(text);
    const CarriedState carried =
        carryState(old.renderer().state(), RendererKind::kConstraint, *before, *after);
    EXPECT_FALSE(carried.goes_on);
    Drive anew(after, RendererKind::kConstraint, settings);
    EXPECT_TRUE(anew.renderer().setState(carried.state));
    const TickResult first = anew.to(mm(0, 0, 10));
    EXPECT_EQ(anew.region(), "outside");
    EXPECT_EQ(first.force, Vec3(0.0));
    double last = 0.0;
    for (int i = 0; i < 49; ++i) {
      const double now = glm::length(anew.to(mm(0, 0, 10)).force);
      EXPECT_GT(now, last);
      last = now;
    }
    EXPECT_GT(last, 1.0);
    std::string all;
    for (const std::string& what : carried.lost) all += what + "; ";
    return all;
  };
  // The skin does not open here: a probe that starts anew is held outside.
  const auto closed = [](std::string text) {
    const auto at = text.find("opens_at: 2 N");
    return text.replace(at, 13, "opens_at: 99 N");
  };
  EXPECT_EQ(lost_in(closed(ballsText("", "", "hull"))), "region 'shell'; ");
  EXPECT_EQ(lost_in(closed(ballsText("", "", "shell", 20.0))),
            "the probe's place in region 'shell'; ");
  std::string renamed = closed(ballsText("", ""));
  for (auto at = renamed.find("skin"); at != std::string::npos; at = renamed.find("skin")) {
    renamed.replace(at, 4, "rind");
  }
  const ScenePtr after = sceneOf(renamed);
  const CarriedState carried =
      carryState(old.renderer().state(), RendererKind::kConstraint, *before, *after);
  EXPECT_TRUE(carried.goes_on) << "its region is there still";
  EXPECT_EQ(carried.lost, std::vector<std::string>{"port 'skin'"});
}

TEST(CarriedState, IntoTheSameSceneEveryExampleGoesOn) {
  for (const char* name :
       {"composite_tube", "container", "crease", "csg", "csg_part", "cup", "fields", "flag",
        "heart", "lattice", "lump", "metaballs", "slab", "sponge", "valve_tube"}) {
    SCOPED_TRACE(name);
    const ScenePtr scene = sceneNamed(name);
    const ScenePtr again = sceneNamed(name);
    Drive hand(scene);
    int ticks = 0;
    for (const Vec3& p : pathThrough(*scene)) {
      (void)hand.to(p);
      if (++ticks % 13 != 0) continue;
      const CarriedState carried =
          carryState(hand.renderer().state(), RendererKind::kConstraint, *scene, *again);
      ASSERT_TRUE(carried.goes_on)
          << ticks << ": " << (carried.lost.empty() ? "" : carried.lost[0]);
      EXPECT_TRUE(carried.lost.empty());
      const auto other = makeRenderer(again);
      const auto same = makeRenderer(scene);
      ASSERT_TRUE(other->setState(carried.state));
      ASSERT_TRUE(same->setState(hand.renderer().state()));
      const TickResult now = other->update({p, Vec3(0.0)});
      const TickResult then = same->update({p, Vec3(0.0)});
      ASSERT_EQ(now.region, then.region) << ticks;
      // A carried state goes on as the original does, except for rounding.
      ASSERT_TRUE(isNear(now.proxy, then.proxy, 1e-12)) << ticks;
    }
  }
}

/// Checks that two renderers feel the same on the way to `goal` [m], from `from` at 0.1 m/s.
void expectTheSameOnTheWay(HapticRenderer& one, HapticRenderer& other, const Vec3& from,
                           const Vec3& goal) {
  const int ticks = static_cast<int>(std::ceil(glm::distance(from, goal) / 1e-4));
  const Vec3 velocity = 0.1 * unitOr(goal - from, Vec3(0.0));
  for (int i = 1; i <= ticks; ++i) {
    const Vec3 p = from + (i / static_cast<double>(ticks)) * (goal - from);
    const TickResult now = one.update({p, velocity});
    const TickResult then = other.update({p, velocity});
    ASSERT_EQ(now.region, then.region) << i;
    // A carried state goes on as the original does, except for rounding.
    ASSERT_TRUE(isNear(now.force, then.force, 1e-9)) << i;
  }
}

TEST(CarriedState, TheContentBehindAnOpenMouthFadesAsItDid) {
  const auto text = [](const std::string& layer_before) {
    return "palpate: 1\nlength: mm\n"
           "materials: {skin: {stiffness: 500 N/m}, syrup: {viscosity: 3 N.s/m}}\nlayers:\n" +
           layer_before +
           "  - {name: side, inside: {sphere: {center: [0, 0, 0], radius: 25}}, wall: skin, "
           "content: syrup}\nports:\n  - {name: mouth, between: [outside, side]}\n";
  };
  const ScenePtr before = sceneOf(text(""));
  const ScenePtr after = sceneOf(
      text("  - {name: wart, inside: {sphere: {center: [90, 0, 0], radius: 5}}, wall: skin}\n"));
  for (const ScenePtr& to : {before, after}) {
    // These depths are within the fade, and far behind it.
    for (const double depth : {0.05, 0.15, 15.0}) {
      SCOPED_TRACE(depth);
      Drive hand(before);
      Vec3 at = mm(0, 0, 35);
      (void)hand.walk(at);
      (void)hand.walk(mm(0, 0, 25.0 - depth));
      at = mm(0, 0, 25.0 - depth);
      ASSERT_EQ(hand.region(), "side");
      const CarriedState carried =
          carryState(hand.renderer().state(), RendererKind::kConstraint, *before, *to);
      ASSERT_TRUE(carried.goes_on);
      EXPECT_TRUE(carried.lost.empty());
      const auto edited = makeRenderer(to);
      ASSERT_TRUE(edited->setState(carried.state));
      // The numbers of the regions differ, so they are not compared there.
      if (to == before) expectTheSameOnTheWay(*edited, hand.renderer(), at, mm(0, 0, 35));
      for (int i = 0; to != before && i < 300; ++i) {
        at.z += 1e-4;
        const HipState hip{at, Vec3(0.0, 0.0, 0.1)};
        ASSERT_TRUE(isNear(edited->update(hip).force, hand.renderer().update(hip).force, 1e-9));
      }
    }
  }
  // A mouth that moved elsewhere is not recognized, and this is reported.
  std::string other = text("");
  other.replace(other.find("radius: 25"), 10, "radius: 26");
  Drive hand(before);
  (void)hand.walk(mm(0, 0, 35));
  (void)hand.walk(mm(0, 0, 20));
  const CarriedState carried =
      carryState(hand.renderer().state(), RendererKind::kConstraint, *before, *sceneOf(other));
  EXPECT_TRUE(carried.goes_on);
  EXPECT_EQ(carried.lost, std::vector<std::string>{"the opening into region 'side'"});
}

TEST(CarriedState, APortThatRestsGoesOnResting) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials: {skin: {stiffness: 500 N/m}}
layers: [{name: side, inside: {sphere: {center: [0, 0, 0], radius: 25}}, wall: skin}]
ports: [{name: c, between: [outside, side], opens_at: 0.5 N, rearm: 30}]
)");
  Drive hand(scene);
  (void)hand.walk(mm(0, 0, 30));
  (void)hand.walk(mm(0, 0, 22.5));
  ASSERT_EQ(hand.region(), "side");
  const CarriedState carried =
      carryState(hand.renderer().state(), RendererKind::kConstraint, *scene, *scene);
  EXPECT_TRUE(carried.lost.empty());
  const auto edited = makeRenderer(scene);
  ASSERT_TRUE(edited->setState(carried.state));
  // The hand goes out again: 5 mm at 500 N/m, where a port that does not rest would open at 0.5 N.
  expectTheSameOnTheWay(*edited, hand.renderer(), mm(0, 0, 22.5), mm(0, 0, 30));
  EXPECT_NEAR(edited->update({mm(0, 0, 30), Vec3(0.0)}).force.z, -2.5, 1e-6);
}

TEST(CarriedState, OfAnotherKindOfRendererItStartsAnew) {
  const ScenePtr scene = sceneNamed("container");
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    const RendererKind wrong =
        kind == RendererKind::kPaper ? RendererKind::kConstraint : RendererKind::kPaper;
    Drive hand(scene, kind);
    (void)hand.walk(mm(0, 0, 30));
    (void)hand.walk(mm(0, 0, 0));
    const RendererState state = hand.renderer().state();
    EXPECT_TRUE(carryState(state, kind, *scene, *scene).goes_on);
    const CarriedState carried = carryState(state, wrong, *scene, *scene);
    EXPECT_FALSE(carried.goes_on);
    EXPECT_EQ(carried.lost.size(), 1U);
    RendererSettings settings;
    settings.kind = wrong;
    const auto other = makeRenderer(scene, settings);
    EXPECT_FALSE(other->setState(state)) << "the other kind's";
    EXPECT_TRUE(other->setState(carried.state));
    EXPECT_TRUE(other->setState(RendererState())) << "that of no tick is of both";
  }
}

}  // namespace
}  // namespace palpate::test
