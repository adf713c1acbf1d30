// Deep pushes, jumps across the object, broken positions: the force is finite and limited, the
// proxy goes where the oracle's goes, and contact is as before afterwards.

#include <gtest/gtest.h>

#include <limits>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"
#include "support/implicit_ellipsoid.h"
#include "support/oracle/closed_forms.h"

namespace palpate::test {
namespace {

struct Solid {
  const char* name;
  FieldPtr field;
  Vec3 free;  ///< [m] outside
};

std::vector<Solid> solids() {
  return {
      {"ball", sphere(Vec3(0.0), 0.06), mm(0, 0, 80)},
      {"box", box(Vec3(0.0), mm(160, 140, 120)), mm(0, 0, 80)},
      {"torus", torus(Vec3(0.0), Vec3(0, 0, 1), 0.1, 0.055), mm(100, 0, 80)},
      {"can", cylinder(Vec3(0.0), Vec3(0, 0, 1), 0.06, 0.12), mm(0, 0, 80)},
      {"quadric", testing::implicitEllipsoid(Vec3(0.0), mm(70, 60, 55)), mm(0, 0, 80)},
      {"capsule", capsule(mm(-40, 0, 0), mm(40, 0, 0), 0.055), mm(0, 0, 80)},
      {"two balls", unite({sphere(mm(-30, 0, 0), 0.06), sphere(mm(30, 0, 0), 0.06)}),
       mm(30, 0, 80)},
      {"metaballs",
       metaballs({{mm(-30, 0, 0), 0.12, 1.0}, {mm(30, 0, 0), 0.12, 1.0}}, FallOff::kWyvill, 0.5),
       mm(30, 0, 100)},
      {"cone", cone(mm(0, 0, -60), Vec3(0, 0, 1), 0.08, 0.14), mm(0, 0, 100)}};
}

TEST(HardJumps, FiveCentimetersDeepSlowlyAndAtOnce) {
  for (const Solid& solid : solids()) {
    for (const double step : {0.5e-3, 0.2}) {
      SCOPED_TRACE(::testing::Message() << solid.name << " step " << step);
      Drive drive(sceneOfSolid(solid.field));
      (void)drive.to(solid.free);
      // Straight down, slightly off every symmetry, until 50 mm below where the surface was met.
      const Vec3 down = glm::normalize(Vec3(0.011, 0.007, -1.0));
      double met = 0.0;
      while (solid.field->value(solid.free + met * down) > 0.0) met += 1e-5;
      const Vec3 deep = solid.free + (met + 0.05) * down;
      const Vec3 before = drive.last().proxy;
      (void)drive.walk(deep, step);
      for (int i = 0; i < 5; ++i) (void)drive.to(deep);
      const TickResult& out = drive.last();
      const auto oracle = oracle::solveOracle(heldBy(solid.field, false), before, deep);
      ASSERT_TRUE(out.contact);
      ASSERT_TRUE(isFinite(out.force));
      ASSERT_GE(solid.field->value(out.proxy), -1e-9);
      EXPECT_TRUE(isNear(out.force, kDefaultK * (out.proxy - deep), 1e-6));
      if (!oracle.ambiguous) {
        EXPECT_LE(oracle.errorOf(out.proxy, deep), 1e-6);
      }
    }
  }
}

TEST(HardJumps, AcrossTheObjectAsTheOracleJumps) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    Judge judge(solid.field, false);
    judge.begin(solid.free);
    Random random(5);
    const Box3 around = solid.field->bounds().grownBy(0.02);
    int ambiguous = 0;
    for (int i = 0; i < 60; ++i) {
      const Vec3 hip = random.in(around);
      const auto oracle =
          oracle::solveOracle(heldBy(solid.field, false), judge.drive().last().proxy, hip);
      // The first tick after the gap, and a few at rest: they finish what one tick's budget does
      // not suffice for.
      const Vec3 first = judge.drive().to(hip).proxy;
      ASSERT_GE(solid.field->value(first), -1e-9) << i;
      for (int k = 0; k < 5; ++k) (void)judge.drive().to(hip);
      const TickResult& out = judge.drive().last();
      ASSERT_GE(solid.field->value(out.proxy), -1e-9) << i;
      if (oracle.ambiguous) {
        ++ambiguous;
        continue;
      }
      EXPECT_TRUE(isNear(out.proxy, oracle.proxy, 1e-6 * glm::length(oracle.proxy - hip) + 1e-9))
          << i << " " << Judge::text(hip);
    }
    EXPECT_LE(ambiguous, 3);
  }
}

TEST(HardJumps, ForceIsCappedWhateverComes) {
  RendererSettings settings;
  settings.limits.max_force = 5.0;
  for (const Solid& solid : solids()) {
    for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
      Drive drive(sceneOfSolid(solid.field), kind, settings);
      (void)drive.to(solid.free);
      Random random(6);
      const Box3 around = solid.field->bounds().grownBy(0.05);
      int capped = 0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 force = drive.to(random.in(around)).force;
        ASSERT_TRUE(isFinite(force)) << solid.name;
        ASSERT_LE(glm::length(force), 5.0 * (1.0 + 1e-12)) << solid.name;
        capped += glm::length(force) > 4.99 ? 1 : 0;
      }
      EXPECT_GT(capped, 100) << solid.name;
    }
  }
}

TEST(HardJumps, ContactIsAsBeforeAfterABadDevice) {
  // NaN, infinity and jumps far away in the middle of a press; then the same press again, from free
  // space.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> bad{Vec3(nan),     Vec3(kInfinity, 0, 0), Vec3(0, -kInfinity, 0),
                              Vec3(1e308),   Vec3(9e3, -9e3, 9e3),  Vec3(0.0),
                              mm(0, 0, -300)};
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const Vec3 down(0.011, 0.007, -1.0);
    double met = 0.0;
    while (solid.field->value(solid.free + met * down) > 0.0) met += 1e-5;
    const Vec3 pressed = solid.free + (met + 0.003) * down;
    Drive clean(sceneOfSolid(solid.field));
    (void)clean.to(solid.free);
    const Vec3 force = clean.walk(pressed).force;
    ASSERT_GT(glm::length(force), 1.0);
    for (const Vec3& p : bad) {
      Drive drive(sceneOfSolid(solid.field));
      (void)drive.to(solid.free);
      (void)drive.walk(pressed);
      const Vec3 velocity(0.0);
      for (int i = 0; i < 3; ++i) {
        const TickResult out = drive.renderer().update({p, velocity});
        ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy));
      }
      // A jump may have led to a flat face on the far side, which holds the hand there, so the hand
      // comes back around the solid.
      for (const Vec3& stop : {mm(300, 0, -300), mm(300, 0, 300), solid.free}) {
        for (int i = 0; i < 3; ++i) (void)drive.to(stop);
        EXPECT_EQ(drive.last().force, Vec3(0.0)) << Judge::text(p);
      }
      EXPECT_TRUE(isNear(drive.walk(pressed).force, force, 1e-6)) << Judge::text(p);
    }
  }
}

TEST(HardJumps, StartsInsideAndExactlyOnTheSurface) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    Random random(7);
    for (int i = 0; i < 20; ++i) {
      // A point on the surface: along a ray from outside, the last point that is outside.
      Vec3 p = random.in(solid.field->bounds());
      const bool on_surface = i % 2 == 0;
      if (on_surface) {
        Vec3 out = solid.free;
        if (solid.field->value(p) > 0.0) continue;
        for (int k = 0; k < 60; ++k) {
          const Vec3 middle = 0.5 * (out + p);
          (solid.field->value(middle) >= 0.0 ? out : p) = middle;
        }
        p = out;
      }
      RendererSettings settings;
      settings.limits.ramp = 0.1;
      Drive drive(sceneOfSolid(solid.field), RendererKind::kConstraint, settings);
      const TickResult first = drive.to(p);
      EXPECT_EQ(glm::length(first.force), 0.0) << "the ramp begins at nothing";
      ASSERT_EQ(first.region, kOutside);
      ASSERT_GE(solid.field->value(first.proxy), -1e-7);
      double last = 0.0;
      for (int k = 0; k < 150; ++k) {
        const double force = glm::length(drive.to(p).force);
        ASSERT_GE(force, last * (1.0 - 1e-9) - 1e-6) << "grows";
        ASSERT_LE(force, last + 0.011 * kDefaultK * 0.2) << "without a kick";
        last = force;
      }
      if (on_surface) {
        EXPECT_LE(last, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
