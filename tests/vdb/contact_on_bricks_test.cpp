// The constraint renderer on grids: a hand feels a baked surface as it would feel the true one.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "lib/render/hard_judge.h"
#include "lib/render/shake.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "support/alloc_guard.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using palpate::test::Drive;
using palpate::test::Hand;
using palpate::test::kDefaultK;
using palpate::test::kDegree;
using palpate::test::sceneOfSolid;
using test::voxels;

constexpr double kMm = 1e-3;

FieldPtr baked(const FieldPtr& field, double voxel, Sampler sampler = Sampler::kCubic) {
  return gridField(bake(*field, voxels(voxel, kCubicHalfWidth)), sampler);
}

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) / kDegree;
}

/// Goes around a great circle in 2 pi, while the circle itself turns about x at a twentieth of that
/// rate.
Vec3 winding(double s) {
  const double turn = s / 20.0;
  return {std::cos(s), std::sin(s) * std::cos(turn), std::sin(s) * std::sin(turn)};
}

bool isSlow() { return std::getenv("PALPATE_SLOW_TESTS") != nullptr; }

TEST(ContactOnBricks, ASphereStrokeHasTheDirectionOfTheTrueSphere) {
  const double radius = 50 * kMm;
  const double depth = 1 * kMm;
  Drive drive(sceneOfSolid(baked(sphere(Vec3(0.0), radius), 0.5 * kMm)));
  (void)drive.to(winding(0.0) * (radius + depth));
  (void)drive.walk(winding(0.0) * (radius - depth));
  const double stride = 0.2e-3 / (radius - depth);  // 0.2 m/s at 1 kHz
  const double rounds = isSlow() ? 10.0 : 2.0;
  double turn = 0.0;
  double strength = 0.0;
  for (double s = 0.0; s < rounds * 360.0 * kDegree; s += stride) {
    const Vec3 hip = winding(s) * (radius - depth);
    const TickResult out = drive.to(hip);
    turn = std::max(turn, angle(out.force, hip));
    strength = std::max(strength, std::fabs(glm::length(out.force) - kDefaultK * depth));
  }
  std::printf("sphere stroke at 0.5 mm: direction %.1e degree, strength %.1e N\n", turn, strength);
  EXPECT_LE(turn, 1e-4);
  EXPECT_LE(strength, 1e-6);
}

/// [N] The largest difference between the force's change from tick to tick and the true change, on
/// a stroke that presses a ball of eight voxels with 3 N.
double worstStep(Sampler sampler, double speed) {
  const double voxel = 1 * kMm;
  const double radius = 8 * voxel;
  const double at = radius - 3.0 / kDefaultK;
  Drive drive(sceneOfSolid(baked(sphere(Vec3(0.31, 0.17, -0.23) * voxel, radius), voxel, sampler)));
  const Vec3 center = Vec3(0.31, 0.17, -0.23) * voxel;
  (void)drive.to(center + winding(0.0) * (radius + 1e-3));
  (void)drive.walk(center + winding(0.0) * at);
  Vec3 before = drive.last().force;
  double worst = 0.0;
  const double stride = speed * 1e-3 / at;
  const double rounds = isSlow() ? 10.0 : 1.0;
  for (double s = stride; s < rounds * 360.0 * kDegree; s += stride) {
    const TickResult out = drive.to(center + winding(s) * at);
    const Vec3 true_change = 3.0 * (winding(s) - winding(s - stride));
    worst = std::max(worst, glm::length(out.force - before - true_change));
    before = out.force;
  }
  return worst;
}

TEST(ContactOnBricks, NoForceStepIsFeltFromVoxelToVoxel) {
  for (const double speed : {0.2, 0.02}) {
    const double cubic = worstStep(Sampler::kCubic, speed);
    const double linear = worstStep(Sampler::kTrilinear, speed);
    std::printf("3 N on a ball of 8 voxels at %.2f m/s: cubic %.1e N, trilinear %.2f N\n", speed,
                cubic, linear);
    EXPECT_LE(cubic, 0.001);
    EXPECT_GT(linear, 0.04);  // can be felt: this is why the cubic sampler is the default
  }
}

TEST(ContactOnBricks, ATorusIsFeltAsTheTrueOneWhereItBendsBothWays) {
  const double ring = 30 * kMm;
  const double tube = 8 * kMm;
  const Vec3 up(0, 0, 1);
  Drive drive(sceneOfSolid(baked(torus(Vec3(0.0), up, ring, tube), 0.5 * kMm)));
  const auto at = [&](double s, double depth) {
    const double around = 3.7 * s;
    const double rho = ring + (tube - depth) * std::cos(around);
    return Vec3(rho * std::cos(s), rho * std::sin(s), (tube - depth) * std::sin(around));
  };
  (void)drive.to(at(0.0, -1 * kMm));
  (void)drive.walk(at(0.0, 1 * kMm));
  double turn = 0.0;
  for (double s = 0.0; s < 360.0 * kDegree; s += 2e-3) {
    const Vec3 hip = at(s, 1 * kMm);
    const TickResult out = drive.to(hip);
    const Vec3 middle = ring * Vec3(std::cos(s), std::sin(s), 0.0);
    turn = std::max(turn, angle(out.force, hip - middle));
  }
  std::printf("torus stroke at 0.5 mm: direction %.1e degree\n", turn);
  // The sampler's error at 16 voxels per radius, and its effect on the saddle
  EXPECT_LE(turn, 1e-3);
}

TEST(ContactOnBricks, AHandFarBelowTheBandIsHeldOnTheSideItCameFrom) {
  // 5 cm deep in a ball of 12 cm whose band is 3 mm: neither value nor gradient is known there.
  const double radius = 60 * kMm;
  const FieldPtr field = baked(sphere(Vec3(0.0), radius), 0.5 * kMm);
  const ScenePtr scene = sceneOfSolid(field);
  ASSERT_FALSE(field->sample(Vec3(10 * kMm, 0, 0)).in_band);
  palpate::test::Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Vec3 u = random.direction();
    Drive drive(scene);
    (void)drive.to(u * (radius + 1.5));  // far outside the band, too
    const Vec3 hip = u * (10 * kMm);
    TickResult out = drive.to(hip);  // in one tick
    EXPECT_TRUE(out.contact);
    for (int n = 0; n < 5; ++n) out = drive.to(hip);
    EXPECT_LE(angle(out.force, u), 1e-3);
    EXPECT_NEAR(glm::length(out.proxy), radius, 1e-3 * kMm);
    // The hand moves around the center by almost half a turn, deep inside, and the proxy follows.
    const Vec3 side = glm::normalize(glm::cross(u, random.direction()));
    for (double s = 0.0; s < 3.0; s += 0.01) {
      const Vec3 there = (u * std::cos(s) + side * std::sin(s)) * 10.0 * kMm;
      out = drive.to(there);
    }
    for (int n = 0; n < 5; ++n) out = drive.to(drive.hip());
    EXPECT_LE(angle(out.force, drive.hip()), 1e-3);
  }
}

TEST(ContactOnBricks, AStartWithinIsPutToTheNearestPointOutside) {
  const double radius = 60 * kMm;
  const ScenePtr scene = sceneOfSolid(baked(sphere(Vec3(0.0), radius), 0.5 * kMm));
  palpate::test::Random random(6);
  for (int i = 0; i < 100; ++i) {
    const double r = random.uniform(1 * kMm, 120 * kMm);
    const Vec3 u = random.direction();
    Drive drive(scene);
    TickResult out;
    for (int n = 0; n < 20; ++n) out = drive.to(r * u);
    ASSERT_TRUE(isFinite(out.force));
    ASSERT_GE(glm::length(out.proxy), radius - 1e-3 * kMm);
    EXPECT_EQ(out.contact, r < radius) << r;
    if (r > radius) {
      EXPECT_EQ(out.proxy, r * u);
    } else if (r > radius - 2 * kMm) {
      EXPECT_LE(glm::length(out.proxy - radius * u), 2e-3 * kMm);
    }
  }
}

TEST(ContactOnBricks, JumpsAcrossTheObjectNeverEndInIt) {
  const double radius = 20 * kMm;
  const FieldPtr truth = torus(Vec3(0.0), Vec3(0, 0, 1), radius, 6 * kMm);
  const ScenePtr scene = sceneOfSolid(baked(truth, 0.5 * kMm));
  Drive drive(scene);
  palpate::test::Random random(7);
  int touched = 0;
  for (int i = 0; i < 4000; ++i) {
    const TickResult out = drive.to(random.in({Vec3(-35 * kMm), Vec3(35 * kMm)}));
    ASSERT_TRUE(isFinite(out.force));
    ASSERT_EQ(out.region, kOutside);
    ASSERT_GE(truth->value(out.proxy), -1e-3 * kMm) << i;
    touched += out.contact ? 1 : 0;
  }
  EXPECT_GT(touched, 40);
}

TEST(ContactOnBricks, AHollowSphereIsFeltFromWithinAndFromWithoutAndNeverPassed) {
  // A wall of four voxels, met at up to 20 m/s.
  const double inner = 30 * kMm;
  const double outer = 31 * kMm;
  const FieldPtr truth = subtract({sphere(Vec3(0.0), outer), sphere(Vec3(0.0), inner)});
  const ScenePtr scene = sceneOfSolid(baked(truth, 0.25 * kMm));
  palpate::test::Random random(8);
  for (const double speed : {1.0, 5.0, 20.0}) {
    const double step = speed * 1e-3;
    for (int phase = 0; phase < 100; ++phase) {
      const Vec3 u = random.direction();
      const Vec3 slant = glm::normalize(u + 0.8 * random.direction());
      Drive within(scene);
      Drive without(scene);
      (void)within.to(0.01 * phase * step * u);
      (void)without.to(u * (outer + 20 * kMm + 0.01 * phase * step));
      for (double s = 0.0; s < 60 * kMm; s += step) {
        (void)within.to(s * slant);
        (void)without.to(u * (outer + 20 * kMm) - s * slant);
        ASSERT_LE(glm::length(within.last().proxy), inner + 0.01 * kMm) << speed << " " << phase;
        ASSERT_GE(glm::length(without.last().proxy), outer - 0.01 * kMm) << speed << " " << phase;
      }
    }
  }
}

TEST(ContactOnBricks, ALongThinTubeIsFeltAllAlong) {
  const double radius = 10 * kMm;
  const Vec3 from(-1.0, 0.013, 0.021);
  const Vec3 to(1.0, -0.017, 0.009);
  const Vec3 along = glm::normalize(to - from);
  const FieldPtr field = baked(capsule(from, to, radius), 1 * kMm);
  Drive drive(sceneOfSolid(field));
  const Vec3 across = glm::normalize(glm::cross(along, Vec3(0, 0, 1)));
  const Vec3 up = glm::cross(along, across);
  const auto at = [&](double s, double r) {
    return from + s * along + r * (std::cos(30.0 * s) * across + std::sin(30.0 * s) * up);
  };
  (void)drive.to(at(0.0, radius + 2 * kMm));
  (void)drive.walk(at(0.0, radius - 1 * kMm));
  double turn = 0.0;
  const double length = glm::length(to - from);
  for (double s = 0.0; s < length; s += 2e-3) {
    const Vec3 hip = at(s, radius - 1 * kMm);
    const TickResult out = drive.to(hip);
    ASSERT_TRUE(out.contact) << s;
    // Where the round ends begin, curvature jumps, and no spline follows that.
    if (s < 5 * kMm || s > length - 5 * kMm) continue;
    turn = std::max(turn, angle(out.force, at(s, 1.0) - at(s, 0.0)));
  }
  std::printf("tube of 2 m at 1 mm: direction %.1e degree\n", turn);
  // Ten voxels per radius: 0.02 (h / r)^3 rad is 1.1e-3 degree RMS.
  EXPECT_LE(turn, 5e-3);
}

TEST(ContactOnBricks, WhatIsNoNumberIsPassedOver) {
  const double radius = 20 * kMm;
  const ScenePtr scene = sceneOfSolid(baked(sphere(Vec3(0.0), radius), 0.5 * kMm));
  Drive drive(scene);
  Drive other(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (double s = 0.0; s < 3.0; s += 0.01) {
    const Vec3 hip = winding(s) * (radius - 1 * kMm * std::sin(4.0 * s));
    for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, inf, 0), Vec3(0, 0, -inf), Vec3(1e300)}) {
      ASSERT_EQ(drive.renderer().update({bad, Vec3(0.0)}).force, Vec3(0.0));
    }
    const TickResult a = drive.renderer().update({hip, Vec3(0.0)});
    const TickResult b = other.renderer().update({hip, Vec3(0.0)});
    ASSERT_EQ(a.force, b.force);
    ASSERT_EQ(a.proxy, b.proxy);
  }
}

struct Solid {
  const char* name;
  FieldPtr truth;
  FieldPtr felt;
  double off;  // [m] allowed error of the sampler
};

std::vector<Solid> solids() {
  const FieldPtr ring = torus(Vec3(0.0), Vec3(1, 1, 0), 20 * kMm, 6 * kMm);
  const FieldPtr drops =
      metaballs({{Vec3(-12 * kMm, 0, 0), 0.03, 1.0}, {Vec3(12 * kMm, 0, 0), 0.03, 1.0}},
                FallOff::kWyvill, 0.5);
  const FieldPtr sponge = intersect({box(Vec3(0.0), Vec3(40 * kMm)), gyroid(Vec3(0.0), 30 * kMm)});
  HybridOptions options;
  options.bake = voxels(1 * kMm, kCubicHalfWidth);
  options.parts = Parts::kOperands;
  return {{"torus", ring, baked(ring, 1 * kMm), 5e-3 * kMm},
          {"drops", drops, baked(drops, 1 * kMm), 5e-3 * kMm},
          {"sponge", sponge, bakeHybrid(sponge, options).field, 5e-3 * kMm}};
}

TEST(ContactOnBricks, ARandomHandNeverGetsTheProxyThroughAWall) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    Drive drive(sceneOfSolid(solid.felt));
    Hand hand(9, solid.truth->bounds().grownBy(5 * kMm));
    const int ticks = isSlow() ? palpate::test::kTicks : 15'000;
    int contacts = 0;
    int unsettled = 0;
    for (int i = 0; i < ticks; ++i) {
      const Vec3 hip = hand.next();
      const TickResult out = drive.renderer().update({hip, Vec3(0.0)});
      ASSERT_TRUE(isFinite(out.force));
      ASSERT_EQ(out.region, kOutside);
      const FieldSample s = solid.truth->sample(out.proxy);
      ASSERT_GE(s.value / std::max(glm::length(s.gradient), 0.1), -solid.off) << i;
      contacts += out.contact ? 1 : 0;
      const Vec3 spring = kDefaultK * (out.proxy - hip);
      unsettled += glm::length(out.force - spring) > 1e-6 * glm::length(spring) + 1e-6 ? 1 : 0;
    }
    std::printf("%s: %d contacts, %d of %d ticks still on the way\n", solid.name, contacts,
                unsettled, ticks);
    EXPECT_GT(contacts, ticks / 20);
    EXPECT_LE(unsettled, ticks / 100);
  }
}

TEST(ContactOnBricks, TwoRunsAgreeBitForBitAndNoTickAllocates) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const ScenePtr scene = sceneOfSolid(solid.felt);
    Drive first(scene);
    Drive second(scene);
    Hand hand(10, solid.truth->bounds().grownBy(5 * kMm));
    for (int i = 0; i < 5000; ++i) {
      const Vec3 hip = hand.next();
      const HipState state{hip, Vec3(0.0)};
      const testing::AllocGuard guard;
      const TickResult a = first.renderer().update(state);
      const std::int64_t violations = guard.violations();
      const TickResult b = second.renderer().update(state);
      ASSERT_EQ(violations, 0);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(a.force[axis]),
                  std::bit_cast<std::uint64_t>(b.force[axis]));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(a.proxy[axis]),
                  std::bit_cast<std::uint64_t>(b.proxy[axis]));
      }
    }
  }
}

TEST(ContactOnBricks, TheEdgeOfAHybridIsAsSharpAsTheTrueOne) {
  // A sponge in a box: over the box's top face and over its edge, where the sponge is solid.
  const FieldPtr wave = gyroid(Vec3(0.0), 60 * kMm);
  const FieldPtr block = box(Vec3(0.0), Vec3(40 * kMm, 40 * kMm, 20 * kMm));
  const FieldPtr tree = intersect({block, wave});
  HybridOptions options;
  options.bake = voxels(1 * kMm, kCubicHalfWidth);
  options.parts = Parts::kOperands;
  const Hybrid hybrid = bakeHybrid(tree, options);
  ASSERT_TRUE(hybrid.parts[1].grid);
  Drive exact(sceneOfSolid(tree));
  Drive felt(sceneOfSolid(hybrid.field));
  int faces = 0;
  int waves = 0;
  for (double s = 0.0; s < 12.0; s += 2e-3) {
    // A hand that sweeps over the block's top, sides and holes, 1 to 2 mm below.
    const Vec3 hip(25 * kMm * std::sin(s), 25 * kMm * std::sin(1.31 * s + 1.0),
                   8.5 * kMm + 4 * kMm * std::cos(5.0 * s));
    const TickResult a = exact.to(hip);
    const TickResult b = felt.to(hip);
    const bool on_top = std::fabs(a.proxy.z - 10 * kMm) < 1e-9 && a.contact &&
                        glm::length(glm::cross(a.force, Vec3(0, 0, 1))) < 1e-9;
    if (on_top && wave->value(a.proxy) < -0.1 * kMm &&
        std::fabs(b.proxy.z - 10 * kMm) < 1e-3 * kMm) {
      ++faces;
      ASSERT_LE(glm::length(a.force - b.force), 1e-9) << s;
    } else if (a.contact && b.contact && glm::length(a.proxy - b.proxy) < 0.1 * kMm) {
      ++waves;
      ASSERT_LE(glm::length(a.force - b.force), 0.05) << s;
    }
  }
  EXPECT_GT(faces, 60);
  EXPECT_GT(waves, 60);
  std::printf("hybrid block: %d ticks on its face, %d on the wave\n", faces, waves);
}

}  // namespace
}  // namespace palpate::vdb
