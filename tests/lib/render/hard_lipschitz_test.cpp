// A field with a false Lipschitz bound: the contract suite reports it, and a renderer that passed
// through its wall because of it finds its way back.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/implicit.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// A plate of 2 mm, 200 mm across, whose value rises ten times faster than it states.
FieldPtr lyingPlate(double declared) {
  UserFunction f;
  f.value = [](const Vec3& p) {
    const Vec3 q = glm::abs(p) - mm(100, 100, 1);
    const double beyond = glm::length(glm::max(q, Vec3(0.0)));
    return 10.0 * (beyond + std::min(0.0, std::max({q.x, q.y, q.z})));
  };
  f.bounds = {mm(-100, -100, -1), mm(100, 100, 1)};
  f.feature_size = 2e-3;
  f.lipschitz = declared;
  return userField(std::move(f));
}

FieldCase caseOf(double declared) {
  FieldCase c;
  c.name = "lying_plate";
  c.make = [=] { return lyingPlate(declared); };
  c.region = {mm(-120, -120, -20), mm(120, 120, 20)};
  c.inside = [](const Vec3& p) {
    return std::fabs(p.x) < 0.1 && std::fabs(p.y) < 0.1 && std::fabs(p.z) < 0.001;
  };
  return c;
}

TEST(HardLipschitz, TheContractSuiteReportsTheLie) {
  const ::testing::AssertionResult lie = checkLipschitz(caseOf(1.0));
  EXPECT_FALSE(lie);
  EXPECT_NE(std::string(lie.message()), "") << "and says where";
  EXPECT_TRUE(checkLipschitz(caseOf(10.0)));
}

TEST(HardLipschitz, AProxyLedThroughTheWallFindsBack) {
  const FieldPtr field = lyingPlate(1.0);
  Drive drive(sceneOfSolid(field));
  Random random(4);
  int led_inside = 0;
  for (int run = 0; run < 300; ++run) {
    // Wild ticks through and around the plate, in which anything may go wrong ...
    for (int i = 0; i < 20; ++i) {
      const TickResult& out = drive.to(random.in({mm(-80, -80, -15), mm(80, 80, 15)}));
      ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy));
      led_inside += field->value(out.proxy) < -1e-6 ? 1 : 0;
    }
    // ... then the hand leaves, and is free (from beneath the plate, around its edge) ...
    for (const Vec3& stop : {mm(300, 0, -60), mm(300, 0, 60), mm(0, 0, 60)}) {
      for (int i = 0; i < 3; ++i) (void)drive.to(stop);
    }
    ASSERT_EQ(drive.last().force, Vec3(0.0)) << run;
    ASSERT_EQ(drive.last().proxy, mm(0, 0, 60)) << run;
    // ... and when it presses slowly, the plate feels as if nothing had happened.
    (void)drive.to(mm(5, 5, 3));
    const TickResult& out = drive.walk(mm(5, 5, 0.5), 0.05e-3);
    ASSERT_TRUE(isNear(out.force, Vec3(0, 0, 0.5), 1e-6)) << run;
    (void)drive.walk(mm(5, 5, 3), 0.05e-3);
  }
  EXPECT_GT(led_inside, 0) << "else there was nothing to recover from";
}

}  // namespace
}  // namespace palpate::test
