// Walls of different materials beside each other on one surface: the press is shared over a patch
// as wide as it is deep, so that the force has a potential, and each wall alone keeps its own law.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/energy_loop.h"
#include "support/alloc_guard.h"

namespace palpate::test {
namespace {

struct Place {
  const char* name;
  const char* layers;
  Vec3 start;   // [m]
  Vec3 center;  // [m] center of the loops
  double reach = 0.7e-3;
};

const Place kPlaces[] = {
    {"two boxes",
     R"(
layers:
  - {name: a, inside: {box: {center: [-10, 0, -5], size: [20, 40, 10]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"a box let into a floor",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"its corner",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 20, -5], size: [20, 40, 10]}}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"four boxes",
     R"(
layers:
  - {name: a, inside: {box: {center: [-10, 10, -5], size: [20, 20, 10]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 10, -5], size: [20, 20, 10]}}, wall: stiff}
  - {name: c, inside: {box: {center: [-10, -10, -5], size: [20, 20, 10]}}, wall: other}
  - {name: d, inside: {box: {center: [10, -10, -5], size: [20, 20, 10]}}, wall: last}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"a slanting seam",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {intersection: [{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}},
      {half_space: {point: [0, 0, 0], normal: [-1, 0.3, 1.4]}}]}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"a ball's cap",
     R"(
layers:
  - {name: a, inside: {sphere: {center: [0, 0, -12], radius: 12}}, wall: soft}
  - {name: b, inside: {intersection: [{sphere: {center: [0, 0, -12], radius: 12}},
      {half_space: {point: [0, 0, -6], normal: [0, 0, -1]}}]}, wall: stiff}
)",
     mm(30, 0, 20), Vec3(0.0116 * std::sqrt(0.75), 0, -0.012 + 0.0116 * 0.5), 0.5e-3},
    {"within a ball of two halves",
     R"(
layers:
  - {name: a, inside: {sphere: {center: [0, 0, 0], radius: 12}}, wall: soft}
  - {name: b, inside: {intersection: [{sphere: {center: [0, 0, 0], radius: 12}},
      {half_space: {point: [0, 0, 0], normal: [1, 0, 0]}}]}, wall: absent}
walls: [{between: [a, outside], wall: soft}, {between: [b, outside], wall: stiff}]
start: {region: a}
)",
     mm(0, 0, 0), mm(0, 0, 12.6)},
    {"a tube's lid",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {cylinder: {center: [-6, 0, -10], axis: [0, 0, 1], radius: 6, height: 20}}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 0, -0.7)},
    {"beside an upright wall",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
  - {name: c, inside: {half_space: {point: [0, 0, 0], normal: [0, 1, 0]}}, wall: other}
)",
     mm(0, 10, 10), mm(0, -0.4, -0.4)},
    {"beside a slanting wall",
     R"(
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
  - {name: c, inside: {half_space: {point: [0, 0, 0], normal: [0, 1, 0.5]}}, wall: other}
)",
     mm(0, 10, 10), mm(0, -0.4, -0.4)},
    {"the edge of a box in two halves",
     R"(
layers:
  - {name: a, inside: {box: {center: [-10, 0, -5], size: [20, 40, 10]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
)",
     mm(0, 0, 10), mm(0, 19.8, -0.5)},
};

ScenePtr sceneOf(const Place& place, const std::string& soft, const std::string& stiff) {
  return test::sceneOf("palpate: 1\nlength: mm\nmaterials:\n  soft: {" + soft + "}\n  stiff: {" +
                       stiff + "}\n  other: {stiffness: 1800 N/m}\n  last: {stiffness: 600 N/m}" +
                       place.layers);
}

struct Pair {
  const char* name;
  const char* soft;
  const char* stiff;
};

const Pair kPairs[] = {
    {"1000|3000 N/m", "stiffness: 1000 N/m", "stiffness: 3000 N/m"},
    {"300|3000 N/m", "stiffness: 300 N/m", "stiffness: 3000 N/m"},
    {"straight|Hertz", "stiffness: 700 N/m",
     "stiffness: 1500 N/m, curve: {exponent: 1.5, reference: 1 mm}"},
    {"texture|stiffening", "stiffness: 1500 N/m, texture: {amplitude: 0.1 mm, wavelength: 3}",
     "stiffness: 400 N/m, curve: {stiffening: 2e5 N/m^2}"},
};

TEST(Seams, GiveNoEnergy) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int loops = slow ? 20 : 1;
  std::size_t turn = 0;
  for (const Place& place : kPlaces) {
    ++turn;
    for (std::size_t k = 0; k < std::size(kPairs); ++k) {
      // Each place takes one pair of walls, in turn, unless there is time for all.
      if (!slow && k != turn % std::size(kPairs)) continue;
      const Pair& pair = kPairs[k];
      const ScenePtr scene = sceneOf(place, pair.soft, pair.stiff);
      Random random(5);
      EnergyGiven worst;
      double most = -kInfinity;
      for (int i = 0; i < loops; ++i) {
        const EnergyLoop loop = randomLoop(random, place.center, 0.05e-3, place.reach);
        const EnergyGiven given = energyGiven(scene, place.start, loop);
        if (given.work - given.change > most) worst = given;
        most = std::max(most, given.work - given.change);
      }
      std::printf("  %-32s %-20s %10.3g J (last halving %.1g J)\n", place.name, pair.name,
                  worst.work, worst.change);
      EXPECT_LE(worst.work, 1e-9 + worst.change) << place.name << ", " << pair.name;
    }
  }
}

TEST(Seams, AreCrossedUnderAPressWithoutGainOrStep) {
  // The hand goes down, across the seam, up, and back above the wall.
  const ScenePtr scene = sceneOf(kPlaces[0], kPairs[0].soft, kPairs[0].stiff);
  const auto renderer = makeRenderer(scene);
  const Vec3 corners[] = {mm(-3, 1, 0.5), mm(-3, 1, -1), mm(3, 1, -1), mm(3, 1, 0.5),
                          mm(-3, 1, 0.5)};
  Vec3 last = corners[0];
  Vec3 force = renderer->update({last, Vec3(0.0), 1e-3}).force;
  double work = 0.0;
  double steepest = 0.0;
  for (int side = 1; side < 5; ++side) {
    constexpr int kSteps = 20'000;
    for (int i = 1; i <= kSteps; ++i) {
      const Vec3 p = glm::mix(corners[side - 1], corners[side], 1.0 * i / kSteps);
      const Vec3 now = renderer->update({p, Vec3(0.0), 1e-3}).force;
      work += 0.5 * glm::dot(force + now, p - last);
      steepest = std::max(steepest, glm::length(now - force) / glm::length(p - last));
      force = now;
      last = p;
    }
  }
  std::printf("  %.3g J, at most %.0f N/m\n", work, steepest);
  // The kinks where a wall is met and left: half a step's change of force times a step, 3000 N/m
  // (0.3 um)^2 / 2 each.
  EXPECT_NEAR(work, 0.0, 1e-9);
  // The stiffness is at most that of the stiffer wall: along the wall the shares add at most 3/4 of
  // the difference.
  EXPECT_LE(steepest, 3000.0 * (1.0 + 1e-6));
}

TEST(Seams, AWallHasItsOwnLawAsFarFromItAsThePressIsDeep) {
  const ScenePtr scene = sceneOf(kPlaces[1], kPairs[0].soft, kPairs[0].stiff);
  for (const double depth : {0.1, 0.5, 1.5, 3.0}) {
    Drive hand(scene);
    (void)hand.to(mm(-6, 0, 1));
    for (double x = -6.0; x < 6.0; x += 0.013) {
      const TickResult r = hand.walk(mm(x, 0.4, -depth));
      if (std::fabs(x) < depth) continue;
      const double stiffness = x < 0.0 ? 1000.0 : 3000.0;
      EXPECT_TRUE(isNear(r.force, stiffness * (r.proxy - mm(x, 0.4, -depth)), 1e-9)) << x;
    }
  }
}

TEST(Seams, SharesAreThoseOfAHertzianPressure) {
  // At a distance s from a straight seam and d deep: E = K d^2 / 2 with
  // K = K1 + (K2 - K1) (1/2 + (3 u - u^3) / 4), u = s / d.
  const ScenePtr scene = sceneOf(kPlaces[0], kPairs[0].soft, kPairs[0].stiff);
  Drive hand(scene);
  (void)hand.to(mm(-2, 0, 1));
  const double d = 1.2e-3;
  const double difference = 2000.0;
  double sideways = 0.0;
  for (double s = -2e-3; s < 2e-3; s += 7e-6) {
    const TickResult r = hand.walk({s, 0.0, -d});
    const double u = std::clamp(s / d, -1.0, 1.0);
    const double stiffness = 1000.0 + difference * (0.5 + 0.25 * u * (3.0 - u * u));
    const double rate = 0.75 * (1.0 - u * u);
    EXPECT_NEAR(r.force.z, stiffness * d - 0.5 * difference * rate * u * d, 1e-8) << s;
    EXPECT_NEAR(r.force.x, -0.5 * difference * rate * d, 1e-8) << s;
    sideways = std::max(sideways, std::fabs(r.force.x) / r.force.z);
  }
  // 3/8 of the difference over the mean, and slightly more where the soft side bears more.
  EXPECT_LE(sideways, 0.4);
}

TEST(Seams, EqualSpringsUnderTwoNamesHaveNone) {
  const ScenePtr scene =
      sceneOf(kPlaces[0], "stiffness: 1000 N/m", "stiffness: 1000 N/m, damping: 0 N.s/m");
  Drive hand(scene);
  (void)hand.to(mm(-3, 0, 1));
  for (double x = -3.0; x < 3.0; x += 0.01) {
    const TickResult r = hand.walk(mm(x, 0.4, -1));
    EXPECT_TRUE(isNear(r.force, Vec3(0, 0, 1.0), 1e-8)) << x;
  }
}

TEST(Seams, FrictionOnlyTakesThere) {
  Random random(3);
  const ScenePtr scene =
      sceneOf(kPlaces[0], "stiffness: 1000 N/m, friction: {static: 0.4, kinetic: 0.3}",
              "stiffness: 3000 N/m, friction: {static: 0.2}");
  expectFrictionTakes("on a seam", scene, random, mm(0, 0, -0.5));
}

TEST(Seams, AWallThatGivesWayBesideOneGivesBackNoMoreThanWasStored) {
  // The hand may go in through the soft half, which opens at 1 N, and out elsewhere; the whole way
  // gives at most what is counted as a source.
  const ScenePtr scene = test::sceneOf(R"(
palpate: 1
length: mm
materials: {soft: {stiffness: 1000 N/m}, stiff: {stiffness: 3000 N/m}}
layers:
  - {name: a, inside: {box: {center: [-10, 0, -5], size: [20, 40, 10]}}, wall: soft}
  - {name: b, inside: {box: {center: [10, 0, -5], size: [20, 40, 10]}}, wall: stiff}
ports:
  - {name: in, between: [outside, a], opens_at: 1 N, back: 0 N}
  - {name: across, between: [a, b], opens_at: 0.5 N, back: 0 N}
  - {name: up, between: [b, outside], opens_at: 0.7 N, back: 0 N}
)");
  Random random(12);
  for (int loop = 0; loop < 20; ++loop) {
    const auto renderer = makeRenderer(scene);
    Vec3 last = mm(0, 0, 3);
    Vec3 force = renderer->update({last, Vec3(0.0), 1e-3}).force;
    double work = 0.0;
    double slack = 1e-9;
    for (int leg = 0; leg < 8; ++leg) {
      const Vec3 from = last;
      const Vec3 to = leg == 7 ? mm(0, 0, 3) : random.in({mm(-2, -2, -4), mm(2, 2, 2)});
      constexpr int kSteps = 8000;
      for (int i = 1; i <= kSteps; ++i) {
        const Vec3 p = glm::mix(from, to, 1.0 * i / kSteps);
        const Vec3 now = renderer->update({p, Vec3(0.0), 1e-3}).force;
        const double step = glm::length(p - last);
        work += 0.5 * glm::dot(force + now, p - last);
        // Where a wall ruptures the force jumps within the tick.
        if (!renderer->entries().empty()) slack += 0.5 * glm::length(now - force) * step;
        force = now;
        last = p;
      }
    }
    EXPECT_LE(work - renderer->sourceWork(), slack) << loop;
  }
}

// A circle inside a union is not a wall, and neither is the line where one more seam comes into the
// patch.
TEST(Seams, AcrossALineWithinAUnionNothingSteps) {
  const ScenePtr scene = palpate::test::sceneOf(R"(
palpate: 1
length: mm
materials: {m0: {stiffness: 1520 N/m}, m1: {stiffness: 354 N/m}, m2: {stiffness: 512 N/m}}
layers:
  - {name: a, inside: {union: [{box: {center: [3, -2, 0], size: [22.1, 15.05, 10]}},
      {cylinder: {center: [-2, -5, 0], axis: [0, 0, 1], radius: 9.55, height: 10}}]}, wall: m2}
  - {name: b, inside: {box: {center: [0, 0, 0], size: [14.54, 14.33, 10]}}, wall: m1}
  - {name: c, inside: {box: {center: [-4, 2, 0], size: [19.1, 26.4, 10]}}, wall: m0}
)");
  EnergyLoop loop;
  loop.center = mm(7.2, -7.867, -2.7);
  loop.wave = {mm(0.4, 0, 0), mm(0, 0, 0.4), Vec3(0.0), Vec3(0.0)};
  const EnergyGiven given = energyGiven(scene, mm(7.2, -7.867, -8), loop);
  EXPECT_LE(std::fabs(given.work), 1e-9);
  Drive hand(scene);
  (void)hand.to(mm(7.2, -7.867, -8));
  Vec3 last = hand.walk(mm(7.0, -7.867, -2.86)).force;
  for (int i = 1; i <= 400; ++i) {
    const Vec3 now = hand.to(mm(7.0 + 0.001 * i, -7.867, -2.86)).force;
    ASSERT_LT(glm::length(now - last), 4.0 * 1520.0 * 1e-6) << i;
    last = now;
  }
}

TEST(Seams, NothingIsAllocatedLockedOrThrown) {
  for (const Place& place : kPlaces) {
    Drive hand(sceneOf(place, kPairs[2].soft, kPairs[3].stiff));
    Random random(8);
    (void)hand.to(place.start);
    (void)hand.walk(place.center);
    const testing::AllocGuard guard;
    for (int i = 0; i < 500; ++i) {
      const TickResult r = hand.to(place.center + random.uniform(0.0, 2e-3) * random.direction());
      EXPECT_TRUE(isFinite(r.force));
    }
    EXPECT_EQ(guard.violations(), 0);
  }
}

}  // namespace
}  // namespace palpate::test
