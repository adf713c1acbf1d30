// Needle insertion: the slab of data/scenes against its model, tick by tick; a needle's contents on
// ways that are not straight; and their energy.

#include "palpate/render/insertion.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "lib/render/drive.h"
#include "lib/render/slab_model.h"
#include "support/energy_meter.h"

namespace palpate::test {
namespace {

using testing::EnergyMeter;

constexpr double kStep = 50e-6;  // [m] a tick: 50 mm/s

/// Moves through the slab along (x, 0, -depth) and compares each tick with the model.
struct SlabRun {
  Drive hand{sceneNamed("slab")};
  SlabModel model;
  EnergyMeter meter;
  double x = 0.0;
  double worst = 0.0;     // [N] largest difference
  double sideways = 0.0;  // [N] force off the needle's axis
  double last = 0.0;      // [m] depth
  std::vector<double> force, shaft, cut;

  void to(double depth, double dt = Drive::kTick) {
    const bool first = force.empty();
    const double speed = first ? 0.0 : (depth - last) / dt;
    last = depth;
    const TickResult r = hand.renderer().update({Vec3(x, 0.0, -depth), Vec3(0.0, 0.0, -speed), dt});
    const double expected = model.step(depth, speed);
    meter.add(Vec3(x, 0.0, -depth), r.force);
    worst = std::max(worst, std::fabs(r.force.z - expected));
    sideways = std::max(sideways, std::hypot(r.force.x, r.force.y));
    force.push_back(r.force.z);
    shaft.push_back(model.shaft_force);
    cut.push_back(model.cut_force);
  }
};

TEST(Insertion, SlabIsItsModelThereAndBackAndInAgain) {
  SlabRun run;
  const std::vector<double> way = thereAndBack(-0.005, 0.045, kStep, 50);
  for (const double depth : way) run.to(depth);
  EXPECT_LT(run.worst, 1e-6);
  EXPECT_LT(run.sideways, 1e-9);
  EXPECT_EQ(run.force.back(), 0.0);
  // Once more through the same holes, which open easily, and through the cut.
  const std::size_t first = run.force.size();
  for (const double depth : way) run.to(depth);
  EXPECT_LT(run.worst, 1e-6);
  double highest_cut = 0.0;
  for (std::size_t i = first; i < run.cut.size(); ++i) {
    highest_cut = std::max(highest_cut, run.cut[i]);
  }
  EXPECT_EQ(highest_cut, 0.0);
  EXPECT_LT(
      *std::max_element(run.force.begin() + static_cast<std::ptrdiff_t>(first), run.force.end()),
      1.0);
}

TEST(Insertion, SlabIsItsModelAtOtherSpeedsAndRates) {
  for (const double speed : {0.00083, 0.01, 0.2}) {
    for (const double dt : {1e-3, 2.5e-4}) {
      SlabRun run;
      for (const double depth : thereAndBack(-0.002, 0.04, speed * dt, 5)) run.to(depth, dt);
      EXPECT_LT(run.worst, 1e-6) << speed << " m/s, " << dt << " s";
    }
  }
}

TEST(Insertion, EachInterfaceIsAnEventAndADropWithinATick) {
  Drive hand(sceneNamed("slab"));
  std::string passed;
  std::vector<double> drops;
  double before = 0.0;
  for (const double depth : thereAndBack(-0.005, 0.045, kStep, 10)) {
    const TickResult r = hand.to(Vec3(0.0, 0.0, -depth));
    const std::string events = hand.events();
    if (!events.empty()) {
      passed += events + (r.force.z > 0.0 ? " " : "/ ");
      drops.push_back(before - r.force.z);
    }
    before = r.force.z;
  }
  EXPECT_EQ(passed,
            "skin_puncture fat_entry fascia_puncture far_side far_side/ fascia_puncture/ "
            "fat_entry/ skin_puncture/ ");
  ASSERT_EQ(drops.size(), 7U);
  EXPECT_GT(drops[0], 2.5);  // from 2.8 N of skin to cutting and friction
  EXPECT_GT(drops[1], 0.2);  // 0.9 N of fascia, minus what muscle adds
  EXPECT_GT(drops[2], 1.0);  // 0.7 N of the far side and 0.6 N of cutting
}

// SOFA's needles have no cutting force after a puncture (haptic toolkits compared: their second
// defect).
TEST(Insertion, CuttingForceGoesOnAfterThePuncture) {
  SlabRun run;
  for (const double depth : thereAndBack(-0.005, 0.030, kStep, 0)) {
    run.to(depth);
    if (run.hand.region() == "fat" && depth > 0.007 && depth < 0.014 && run.model.pierced == 0 &&
        run.force.size() < 700) {
      EXPECT_NEAR(run.cut.back(), 0.15, 1e-12);
      EXPECT_GT(run.force.back(), 0.15);
    }
    if (depth > 0.0299) {
      EXPECT_GT(run.force.back(), 0.6);
    }
  }
  EXPECT_LT(run.worst, 1e-6);
}

TEST(Insertion, FarSideHoldsTheShaftUntilItIsDrawnOut) {
  SlabRun run;
  const std::vector<double> way = thereAndBack(-0.005, 0.045, kStep, 50);
  for (std::size_t i = 0; i < way.size() / 2; ++i) run.to(way[i]);
  EXPECT_EQ(run.hand.last().region, kOutside);
  EXPECT_FALSE(run.hand.renderer().update({Vec3(0.0, 0.0, -0.045)}).contact);
  // At rest: kinetic friction of 2 mm of skin, 12 mm of fat and 18 mm of muscle.
  EXPECT_NEAR(run.force.back(), 2e-3 * 16 + 12e-3 * 3 + 18e-3 * 10, 1e-6);
}

TEST(Insertion, BoneStopsIt) {
  Drive hand(sceneNamed("slab"));
  for (double depth = -0.005; depth < 0.0225; depth += kStep) {
    (void)hand.to(Vec3(0.02, 0.0, -depth));
  }
  EXPECT_TRUE(hand.last().contact);
  EXPECT_EQ(hand.region(), "muscle");
  EXPECT_NEAR(hand.last().proxy.z, -0.019, 1e-9);
  // 3000 N/m of bone, and friction of skin, fat and 5 mm of muscle; no more muscle is cut.
  const double speed = kStep / Drive::kTick;
  const double bone = 3000.0 * (-hand.hip().z - 0.019);
  const double shaft =
      2e-3 * (16 + 120 * speed) + 12e-3 * (3 + 60 * speed) + 5e-3 * (10 + 290 * speed);
  EXPECT_NEAR(hand.last().force.z, bone + shaft, 1e-6);
}

// The slew rate permits a puncture's drop at once, and limits only the force after it.
TEST(Insertion, SlewLimitLetsThePunctureDrop) {
  RendererSettings settings;
  settings.limits.max_growth = 200.0;  // [N/s]: 0.2 N a tick, faster than the skin is pressed
  Drive free(sceneNamed("slab"));
  Drive limited(sceneNamed("slab"), RendererKind::kConstraint, settings);
  bool dropped = false;
  for (double depth = -0.005; depth < 0.008; depth += kStep) {
    const double before = limited.last().force.z;
    const double now = limited.to(Vec3(0.0, 0.0, -depth)).force.z;
    EXPECT_EQ(now, free.to(Vec3(0.0, 0.0, -depth)).force.z);
    if (limited.last().event_count > 0) {
      dropped = true;
      EXPECT_GT(before - now, 2.0);
    }
  }
  EXPECT_TRUE(dropped);
}

// A hand that trembles at the depth where the skin opened.
TEST(Insertion, DoesNotFireAgainWhileTheHandTrembles) {
  Drive hand(sceneNamed("slab"));
  double depth = -0.005;
  while (hand.events().empty()) {
    depth += kStep;
    (void)hand.to(Vec3(0.0, 0.0, -depth));
  }
  for (int i = 0; i < 2000; ++i) {
    (void)hand.to(Vec3(0.0, 0.0, -(depth + 200e-6 * std::sin(0.9 * i))));
  }
  EXPECT_EQ(hand.events(), "");
}

TEST(Insertion, ThereAndBackTakesEnergyAndGivesNone) {
  SlabRun run;
  const std::vector<double> way = thereAndBack(-0.005, 0.045, kStep, 50);
  for (const double depth : way) run.to(depth);
  // A force held for a tick leaks up to half a tick's way times its change: for springs of 150 N/m
  // to 300 N/m and a way of 50 um, some 1e-9 J in a tick; while it is pressed, 1e-6 J in total.
  EXPECT_LT(run.meter.gained(), 1e-6);
  EXPECT_LT(run.meter.work(), -0.02);
}

std::string jelly(const std::string& material) {
  return R"(
palpate: 1
length: mm
materials: {jelly: {)" +
         material + R"(}}
layers: [{name: jelly, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, content: jelly, wall: jelly}]
ports: [{name: top, between: [outside, jelly]}]
)";
}

const char* const kNeedled =
    "stiffness: 300 N/m, cutting: 0.5 N, shaft: {stiffness: 1e5 N/m^2, in: {static: 12 N/m, "
    "kinetic: 8 N/m, damping: 50 N.s/m^2}}";

// Any way, in, out and around: the work summed from the force sent to the hand.
TEST(Insertion, WanderingNeverGivesEnergy) {
  std::mt19937 random(5);
  std::normal_distribution<double> push(0.0, 1.0);
  Drive hand(sceneOf(jelly(kNeedled)));
  EnergyMeter meter;
  Vec3 p(0.0, 0.0, 0.002);
  Vec3 v(0.0);
  double leak = 0.0;
  Vec3 last_force(0.0);
  for (int i = 0; i < 60000; ++i) {
    v += 0.02e-6 * Vec3(push(random), push(random), push(random)) * 20.0;
    v -= 4e-6 * (p + Vec3(0.0, 0.0, 0.004)) + 0.002 * v;
    const Vec3 way = v;
    p += way;
    const TickResult r = hand.to(p);
    // A changing force that is held for a tick leaks up to its change times the way.
    leak += glm::length(r.force - last_force) * glm::length(way);
    last_force = r.force;
    meter.add(p, r.force);
    ASSERT_LE(meter.gained(), leak + 1e-9) << i;
  }
  EXPECT_LT(meter.work(), -0.01);
  EXPECT_LT(leak, 0.2 * std::fabs(meter.work()));
}

TEST(Insertion, SidewaysTheTissueHoldsTheTipUntilItIsCut) {
  Drive hand(sceneOf(jelly("stiffness: 300 N/m, cutting: 0.5 N")));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -10), 50e-6);
  (void)hand.walk(mm(0, 0, -8), 50e-6);  // slack, end at -10 + 0.5 / 0.3
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  (void)hand.walk(mm(1, 0, -8), 50e-6);
  EXPECT_TRUE(isNear(hand.last().force, Vec3(-0.3, 0.0, 0.0), 1e-6));
  (void)hand.walk(mm(4, 0, -8), 50e-6);
  EXPECT_NEAR(glm::length(hand.last().force), 0.5, 1e-9);
}

TEST(Insertion, AnotherPlaceIsNotCutYet) {
  Drive hand(sceneOf(jelly("stiffness: 300 N/m, cutting: 0.5 N")));
  const auto peak = [&](double x) {
    (void)hand.walk(mm(x, 0, 2), 50e-6);
    double highest = 0.0;
    for (double z = 2.0; z > -10.0; z -= 0.05) {
      highest = std::max(highest, hand.to(mm(x, 0, z)).force.z);
    }
    (void)hand.walk(mm(x, 0, 2), 50e-6);
    return highest;
  };
  EXPECT_NEAR(peak(0.0), 0.5, 1e-9);
  EXPECT_NEAR(peak(0.0), 0.5, 1e-9);  // on the last 1.7 mm it only pressed, without cutting
  EXPECT_NEAR(peak(5.0), 0.5, 1e-9);
  double highest = 0.0;
  for (double z = 2.0; z > -8.0; z -= 0.05) {
    highest = std::max(highest, hand.to(mm(5, 0, z)).force.z);
  }
  EXPECT_NEAR(highest, 0.0, 1e-12);
}

// The needle began inside, or the content was changed and holds needles now: where the shaft
// entered is not known, and it comes out free.
TEST(Insertion, BegunInsideItComesOutFree) {
  Drive hand(sceneOf(jelly(kNeedled) + "start: {region: jelly}\n"));
  (void)hand.to(mm(0, 0, -5));
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  (void)hand.walk(mm(0, 0, -9), 50e-6);
  EXPECT_NEAR(hand.last().force.z, 0.5 + 0.004 * 8.0, 1e-6);
  (void)hand.walk(mm(0, 0, 4), 50e-6);
  EXPECT_EQ(hand.region(), "outside");
  EXPECT_EQ(hand.last().force, Vec3(0.0));

  Drive soft(sceneOf(jelly("stiffness: 300 N/m")));
  (void)soft.walk(mm(0, 0, 4));
  (void)soft.walk(mm(0, 0, -5));
  EXPECT_TRUE(soft.renderer().setContent(1, {.cutting = 0.3}));
  (void)soft.walk(mm(0, 0, -9));
  EXPECT_NEAR(soft.last().force.z, 0.3, 1e-9);
  (void)soft.walk(mm(0, 0, 4));
  EXPECT_EQ(soft.last().force, Vec3(0.0));
}

// More tissues than it can hold at a time, and more cuts than it can remember: bounded, and
// harmless.
TEST(Insertion, HundredLayersAndHundredCuts) {
  std::string text =
      "palpate: 1\nlength: mm\nmaterials: {a: {stiffness: 200 N/m, cutting: 0.1 N, shaft: "
      "{stiffness: 1e5 N/m^2, in: {static: 5 N/m}}}}\nlayers:\n";
  std::string ports = "ports: [{name: all, between: [\"*\", \"*\"]}]\n";
  for (int i = 0; i < 100; ++i) {
    text += "  - {name: l" + std::to_string(i) +
            ", content: a, wall: a, inside: {half_space: {point: [0, 0, " +
            std::to_string(-0.5 * i) + "], normal: [0, 0, 1]}}}\n";
  }
  Drive hand(sceneOf(text + ports));
  for (int i = 0; i < 100; ++i) {
    (void)hand.walk(mm(2.0 * i, 0, 3));
    (void)hand.walk(mm(2.0 * i, 0, i % 10 == 0 ? -45.0 : -3.45), 0.2e-3);
    EXPECT_TRUE(isFinite(hand.last().force));
    // 3.45 mm of shaft, with the tip pressed 0.45 mm in the last layer; or so many layers that all
    // let go.
    EXPECT_NEAR(hand.last().force.z, i % 10 == 0 ? 0.0 : 0.09 + 0.00345 * 5.0, 1e-6);
    (void)hand.walk(mm(2.0 * i, 0, 3), 0.2e-3);
    EXPECT_EQ(hand.last().force, Vec3(0.0));
  }
}

// Beyond the far side the tip moves around the slab: the needle is out, without a kick.
TEST(Insertion, WalkingRoundTheFarSideLetsGo) {
  Drive hand(sceneNamed("slab"));
  (void)hand.walk(mm(0, 0, 5));
  (void)hand.walk(mm(0, 0, -45), kStep);
  EXPECT_GT(glm::length(hand.last().force), 0.2);
  for (const Vec3& p : {mm(60, 0, -45), mm(60, 0, 20), mm(0, 0, 20)}) {
    (void)hand.walk(p, 0.5e-3);
    EXPECT_LT(glm::length(hand.last().force), 0.6);
  }
  EXPECT_EQ(hand.last().force, Vec3(0.0));
  EXPECT_EQ(hand.region(), "outside");
}

// A file of states may contain anything. Here each of these words is set to a value beyond any
// valid count or region: the number of layers, that of cuts, the index of the next cut, and the
// region. These alone decide whether the state fits the scene.
TEST(Insertion, AStateIsRefusedForEachCountThatIsBeyondItsRoom) {
  static_assert(std::is_trivially_copyable_v<Insertion>);
  constexpr std::uint64_t kMuch = 0x0101010101010101;
  int refused = 0;
  for (std::size_t at = 0; at + sizeof kMuch <= sizeof(Insertion); at += sizeof kMuch) {
    Insertion needle;
    ASSERT_TRUE(needle.isOf(1));
    std::memcpy(reinterpret_cast<std::byte*>(&needle) + at, &kMuch, sizeof kMuch);
    refused += needle.isOf(1) ? 0 : 1;
  }
  EXPECT_EQ(refused, 4);
}

}  // namespace
}  // namespace palpate::test
