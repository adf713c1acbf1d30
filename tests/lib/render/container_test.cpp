// The container of the paper's Table I, every row of it, with both renderers.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kK = 1500.0;  // [N/m]
constexpr double kBv = 4.0;    // [N s/m]

class Container : public testing::TestWithParam<RendererKind> {
 protected:
  Container() : drive_(sceneOf(containerText()), GetParam()) {}

  /// The paper's method bisects to a micrometer, so its tolerance is that times K. The constraint
  /// renderer is exact.
  [[nodiscard]] static double tolerance() {
    return GetParam() == RendererKind::kPaper ? 2e-6 * kK : 1e-9;
  }

  Drive drive_;
};

INSTANTIATE_TEST_SUITE_P(Renderers, Container,
                         testing::Values(RendererKind::kPaper, RendererKind::kConstraint),
                         kindName);

TEST_P(Container, Row1FromOutsideIsPressedRadially) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    drive_.renderer().reset();
    Vec3 u = random.direction();
    if (u.z > 0.2) u.z = -u.z;
    EXPECT_EQ(drive_.to(0.05 * u).force, Vec3(0.0));
    for (const double depth : {0.1e-3, 1e-3, 5e-3, 2e-3, 0.2e-3}) {
      const TickResult& out = drive_.walk((0.04 - depth) * u);
      EXPECT_TRUE(isNear(out.force, kK * depth * u, tolerance()));
      EXPECT_TRUE(out.contact);
      EXPECT_EQ(out.region, kOutside);
      EXPECT_TRUE(isNear(out.proxy, 0.04 * u, 2e-6));
    }
    const TickResult& away = drive_.walk(0.05 * u);
    EXPECT_EQ(away.force, Vec3(0.0));
    EXPECT_FALSE(away.contact);
    EXPECT_EQ(away.proxy, drive_.hip());
    EXPECT_EQ(drive_.events(), "");
  }
}

TEST_P(Container, Rows3And4WithoutEnteringAreFree) {
  for (const Vec3& p : {mm(50, 0, 0), mm(0, 0, -60), mm(50, 0, 20), mm(0, 0, 60), mm(45, 0, 14)}) {
    drive_.renderer().reset();
    const TickResult& out = drive_.walk(p);
    EXPECT_EQ(out.force, Vec3(0.0));
    EXPECT_EQ(out.region, kOutside);
    EXPECT_FALSE(out.contact);
  }
}

TEST_P(Container, EntersAndLeavesByTheMouth) {
  (void)drive_.walk(mm(5, 3, 30));
  EXPECT_EQ(drive_.last().force, Vec3(0.0)) << "row 2: above the brim, in the ball";
  (void)drive_.walk(mm(5, 3, 5));
  EXPECT_EQ(drive_.events(), "mouth");
  EXPECT_EQ(drive_.region(), "liquid");
  // Row 1, entered: only the drag of the syrup.
  const TickResult& moving = drive_.to(mm(5, 3.2, 4.9));
  EXPECT_TRUE(isNear(moving.force, -kBv * mm(0, 0.2, -0.1) / Drive::kTick, 1e-12));
  EXPECT_FALSE(moving.contact);
  EXPECT_EQ(drive_.to(drive_.hip()).force, Vec3(0.0)) << "at rest nothing";

  (void)drive_.walk(mm(-5, 0, 30));
  EXPECT_EQ(drive_.events(), "mouth");
  EXPECT_EQ(drive_.region(), "outside");
  EXPECT_EQ(drive_.to(mm(-5, 0, 29)).force, Vec3(0.0)) << "row 2: no syrup up here";
  // Outside again, met from outside, the ball is as in row 1.
  (void)drive_.walk(mm(-60, 0, 30));
  (void)drive_.walk(mm(-60, 0, 0));
  EXPECT_TRUE(isNear(drive_.walk(mm(-39, 0, 0)).force, Vec3(-kK * 1e-3, 0, 0), tolerance()));
}

TEST_P(Container, Row3EnteredIsTheWallFromWithin) {
  (void)drive_.walk(mm(0, 0, 30));
  (void)drive_.walk(mm(0, 0, 0));
  EXPECT_EQ(drive_.events(), "mouth");
  for (const Vec3& u : {Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0.6, 0, -0.8), Vec3(0, -0.8, -0.6)}) {
    for (const double depth : {0.2e-3, 1e-3, 4e-3}) {
      (void)drive_.walk(mm(0, 0, 0));
      const TickResult& out = drive_.walk((0.04 + depth) * u);
      EXPECT_TRUE(isNear(out.force, -kK * depth * u, tolerance())) << "inward";
      EXPECT_TRUE(out.contact);
      EXPECT_EQ(drive_.region(), "liquid");
    }
  }
  EXPECT_EQ(drive_.events(), "") << "no port but the mouth";
  (void)drive_.walk(mm(0, 0, 0));
  (void)drive_.walk(mm(0, 0, 30));
  EXPECT_EQ(drive_.events(), "mouth");
}

TEST_P(Container, TheMouthIsNotEnteredWithoutPassingIt) {
  // Sideways through the glass into the middle: it was never entered, so there is no syrup.
  (void)drive_.walk(mm(60, 0, 0));
  (void)drive_.walk(mm(10, 0, 0));
  EXPECT_EQ(drive_.region(), "outside");
  EXPECT_EQ(drive_.events(), "");
  EXPECT_TRUE(drive_.last().contact);
  EXPECT_TRUE(isFinite(drive_.last().force));
  EXPECT_GT(drive_.last().force.x, 0.0) << "pushed back out";
}

TEST(ContainerRim, TheProxySlidesOverItFromOutside) {
  Drive drive(sceneOf(containerText()));
  // The hand goes up a meridian, 1 mm deep: the wall is pressed until the proxy reaches the rim (z
  // = 15), then the proxy drops in.
  const double rim = std::asin(15.0 / 40.0);
  (void)drive.walk(mm(39, 0, 0));
  for (double angle = 0.0; angle < rim + 0.1; angle += 1e-3) {
    const Vec3 u(std::cos(angle), 0, std::sin(angle));
    const TickResult& out = drive.to(0.039 * u);
    if (angle < rim - 1e-9) {
      ASSERT_TRUE(isNear(out.force, kK * 1e-3 * u, 1e-9)) << angle;
      ASSERT_EQ(drive.region(), "outside");
    } else if (angle < std::asin(15.0 / 39.0)) {
      ASSERT_EQ(drive.region(), "liquid") << "beyond the rim nothing holds it";
      ASSERT_FALSE(out.contact);
      ASSERT_EQ(out.proxy, drive.hip());
    } else {
      ASSERT_EQ(drive.region(), "outside") << "the HIP, and with it the proxy, leaves by the mouth";
      ASSERT_EQ(out.force, Vec3(0.0));
    }
  }
  EXPECT_EQ(drive.events(), "mouth mouth");
}

TEST(ContainerRim, TheProxySlidesOverItFromInside) {
  Drive drive(sceneOf(containerText()));
  (void)drive.walk(mm(0, 0, 30));
  (void)drive.walk(mm(0, 0, 0));
  (void)drive.walk(mm(41, 0, 0));
  EXPECT_EQ(drive.events(), "mouth");
  const double rim = std::asin(15.0 / 40.0);
  for (double angle = 0.0; angle < rim + 0.1; angle += 1e-3) {
    const Vec3 u(std::cos(angle), 0, std::sin(angle));
    const Vec3 velocity = (0.041 * u - drive.hip()) / Drive::kTick;
    const TickResult& out = drive.to(0.041 * u);
    if (angle < rim - 1e-9) {
      // The drag fades with the distance to the mouth, so its size is known only away from the
      // mouth.
      const double drag = angle < rim - 0.02 ? kBv : 0.0;
      const double slack = angle < rim - 0.02 ? 1e-9 : kBv * glm::length(velocity) + 1e-9;
      ASSERT_TRUE(isNear(out.force, -kK * 1e-3 * u - drag * velocity, slack)) << angle;
      ASSERT_EQ(drive.region(), "liquid");
    } else {
      ASSERT_EQ(drive.region(), "outside") << angle;
      ASSERT_EQ(out.force, Vec3(0.0));
      ASSERT_EQ(out.proxy, drive.hip());
    }
  }
  EXPECT_EQ(drive.events(), "mouth");
  // Outside, the glass is felt from outside.
  (void)drive.walk(mm(60, 0, 20));
  (void)drive.walk(mm(60, 0, 0));
  EXPECT_TRUE(isNear(drive.walk(mm(39, 0, 0)).force, Vec3(kK * 1e-3, 0, 0), 1e-9));
}

TEST(ContainerContent, FadesInBehindTheMouth) {
  Drive drive(sceneOf(containerText()));
  (void)drive.walk(mm(0, 0, 16));
  const double speed = 0.02;  // [m/s]: 0.02 mm a tick
  double last = 0.0;
  for (double z = 15.1; z > 14.0; z -= 0.02) {
    const double drag = drive.to(mm(0, 0, z)).force.z;
    if (z < 14.9) {
      EXPECT_GE(drag, last - 1e-9) << "grows";
    }
    if (z > 15.0) {
      EXPECT_EQ(drag, 0.0);
    }
    if (z < 14.7) {
      EXPECT_NEAR(drag, kBv * speed, 1e-9);
    }
    EXPECT_LT(drag - last, 0.1 * kBv * speed) << "without a step";
    last = drag;
  }
}

TEST(ContainerFile, BothRenderersReadTheSceneOfTheProject) {
  for (const RendererKind kind : {RendererKind::kPaper, RendererKind::kConstraint}) {
    Drive drive(sceneNamed("container"), kind);
    (void)drive.walk(mm(0, 0, 50));
    (void)drive.walk(mm(0, 0, -41));
    EXPECT_EQ(drive.region(), "liquid");
    EXPECT_TRUE(isNear(drive.last().force, Vec3(0, 0, kK * 1e-3), 2e-6 * kK));
    (void)drive.walk(mm(0, 0, 50));
    EXPECT_EQ(drive.events(), "mouth mouth");
    (void)drive.walk(mm(60, 0, 50));
    (void)drive.walk(mm(60, 0, 0));
    const TickResult& out = drive.walk(mm(39, 0, 0));
    EXPECT_TRUE(isNear(out.force, Vec3(kK * 1e-3, 0, 0), 2e-6 * kK));
    // Damping acts against the motion: it adds on the way in, and on the way out the force never
    // pulls.
    EXPECT_GT(drive.to(mm(38.9, 0, 0)).force.x, kK * 1.1e-3 + 0.05);
  }
}

}  // namespace
}  // namespace palpate::test
