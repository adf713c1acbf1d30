// The constraint renderer against closed forms: where the closest point of the wall is known, the
// force is K (closest - P), to 1e-6 degree and better.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "lib/render/drive.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kK = 1000.0;  // [N/m], the default wall

std::string oneLayer(const std::string& field, bool from_within = false) {
  return "palpate: 1\nlength: mm\nlayers: [{name: solid, inside: {" + field + "}}]\n" +
         (from_within ? "start: {region: solid}\n" : "");
}

/// A random walk at `speed` [m/s] and 1 kHz; `keep` moves each point to where the closed form is
/// known.
void stroke(Drive& drive, double speed, int ticks, const std::function<Vec3(const Vec3&)>& keep,
            const std::function<Vec3(const Vec3&)>& closest, Vec3 p) {
  Random random(21);
  Vec3 heading = random.direction();
  double worst_angle = 0.0;
  double worst = 0.0;
  for (int i = 0; i < ticks; ++i) {
    heading = glm::normalize(heading + 0.2 * random.direction());
    p = keep(p + speed * Drive::kTick * heading);
    const Vec3 expected = kK * (closest(p) - p);
    const TickResult& out = drive.to(p);
    ASSERT_TRUE(out.contact) << i;
    const double size = glm::length(expected);
    worst = std::max(worst, glm::length(out.force - expected) / size);
    worst_angle = std::max(worst_angle, glm::length(glm::cross(out.force, expected)) /
                                            (glm::length(out.force) * size));
    ASSERT_LT(worst, 1e-7) << "tick " << i << " at " << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_LT(worst_angle * 57.29577951308232, 1e-6) << "degrees, at " << speed << " m/s";
}

TEST(Accuracy, BallConvexAndHollowOfEverySize) {
  for (const double radius : {0.05, 0.01, 0.002, 0.0005}) {
    for (const bool hollow : {false, true}) {
      // The hand presses up to 0.9 R deep on the outside, up to 20 R in the hollow.
      for (const double share : {0.02, 0.5, hollow ? 20.0 : 0.9}) {
        // A tick turns the hand by at most 0.3 rad as seen from the center: for larger turns the
        // direction around the ball is not unique.
        const double rho = radius * (hollow ? 1.0 + share : 1.0 - share);
        const double speed = std::min(0.2, 0.3 * rho / Drive::kTick);
        Drive drive(sceneOf(oneLayer(
            "sphere: {center: [0, 0, 0], radius: " + std::to_string(radius * 1e3) + "}", hollow)));
        const Vec3 free = Vec3(radius * (hollow ? 0.5 : 1.5), 0, 0);
        (void)drive.walk(free, 0.1 * radius);
        (void)drive.walk(Vec3(rho, 0, 0), 0.05 * radius);
        SCOPED_TRACE(testing::Message()
                     << "R " << radius << " hollow " << hollow << " d/R " << share);
        stroke(
            drive, speed, 1500, [&](const Vec3& p) { return rho * glm::normalize(p); },
            [&](const Vec3& p) { return radius * glm::normalize(p); }, Vec3(rho, 0, 0));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(Accuracy, PlaneAtEverySpeed) {
  for (const double speed : {0.2, 5.0, 20.0}) {
    Drive drive(sceneOf(oneLayer("half_space: {point: [1, 2, 3], normal: [1, 2, 3]}")));
    const Vec3 n = glm::normalize(Vec3(1, 2, 3));
    const Vec3 at = mm(1, 2, 3);
    (void)drive.walk(at + 0.001 * n);
    (void)drive.walk(at - 0.001 * n);
    const auto closest = [&](const Vec3& p) { return p - n * glm::dot(n, p - at); };
    stroke(
        drive, speed, 2000, [&](const Vec3& p) { return closest(p) - 0.001 * n; }, closest,
        at - 0.001 * n);
  }
}

TEST(Accuracy, CylinderSideOutsideAndWithin) {
  const double radius = 0.02;
  for (const bool within : {false, true}) {
    for (const double depth : {1e-3, 8e-3}) {
      Drive drive(sceneOf(oneLayer(
          "cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 20, height: 100}", within)));
      const double rho = radius + (within ? depth : -depth);
      const auto at = [&](const Vec3& p, double r) {
        const Vec3 u = glm::normalize(Vec3(p.x, p.y, 0));
        return Vec3(r * u.x, r * u.y, std::clamp(p.z, -0.035, 0.035));
      };
      (void)drive.walk(Vec3(within ? 0.01 : 0.03, 0, 0));
      (void)drive.walk(Vec3(rho, 0, 0));
      stroke(
          drive, 0.2, 3000, [&](const Vec3& p) { return at(p, rho); },
          [&](const Vec3& p) { return at(p, radius); }, Vec3(rho, 0, 0));
    }
  }
}

const Vec3 kHalf(0.03, 0.02, 0.01);
const std::string kBox = "box: {center: [0, 0, 0], size: [60, 40, 20]}";

TEST(Accuracy, BoxFacesFromOutside) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      Drive drive(sceneOf(oneLayer(kBox)));
      Vec3 out(0.0);
      out[axis] = side * (kHalf[axis] + 0.002);
      Vec3 in(0.0);
      in[axis] = side * (kHalf[axis] - 0.002);
      (void)drive.walk(out);
      (void)drive.walk(in);
      const auto keep = [&](Vec3 p) {
        p = glm::clamp(p, -0.999 * kHalf, 0.999 * kHalf);  // on the whole face, up to its edges
        p[axis] = in[axis];
        return p;
      };
      const auto closest = [&](Vec3 p) {
        p[axis] = side * kHalf[axis];
        return p;
      };
      stroke(drive, 0.2, 2000, keep, closest, in);
    }
  }
}

TEST(Accuracy, AConvexEdgeHoldsItsFaceAndThenLetsGo) {
  Drive drive(sceneOf(oneLayer(kBox)));
  (void)drive.walk(mm(0, 0, 12));
  (void)drive.walk(mm(0, 0, 8));
  // The hand goes over the edge at x = 30, 2 mm deep: the force is K d on the top face until it
  // ends, then zero.
  for (double x = 0.0; x < 40.0; x += 0.25) {
    const TickResult& out = drive.to(mm(x, 0, 8));
    if (x == 30.0) continue;  // exactly on the edge both are right
    if (x < 30.0) {
      ASSERT_TRUE(isNear(out.force, Vec3(0, 0, 2.0), 1e-9)) << x;
    } else {
      ASSERT_EQ(out.force, Vec3(0.0)) << x;
    }
  }
  // On the way back it meets the side face.
  EXPECT_TRUE(isNear(drive.walk(mm(29, 0, 8)).force, Vec3(1.0, 0, 0), 1e-9));
  // A corner met along its diagonal: some face holds the proxy, and the force is finite and
  // outward.
  Drive corner(sceneOf(oneLayer(kBox)));
  (void)corner.walk(1.2 * kHalf);
  const TickResult& out = corner.walk(0.97 * kHalf);
  EXPECT_TRUE(out.contact);
  EXPECT_GT(glm::dot(out.force, kHalf), 0.0);
  const Vec3 gap = kHalf - 0.97 * kHalf;
  const double nearest = kK * std::min({gap.x, gap.y, gap.z});
  const double farthest = kK * std::max({gap.x, gap.y, gap.z});
  EXPECT_GE(glm::length(out.force), nearest - 1e-9);
  EXPECT_LE(glm::length(out.force), farthest + 1e-9);
}

TEST(Accuracy, FrictionSticksAndSlidesByItsCone) {
  const std::string text = R"(
palpate: 1
length: mm
materials: {felt: {stiffness: 1000 N/m, friction: {static: 0.5, kinetic: 0.3}}}
layers: [{name: table, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: felt}]
)";
  Drive drive(sceneOf(text));
  (void)drive.walk(mm(0, 0, 5));
  (void)drive.walk(mm(0, 0, -2));
  // Pressed with 2 N: it sticks up to a pull of 1 N, and then drags with 0.6 N.
  bool slid = false;
  for (double x = 0.0; x < 5.0; x += 0.05) {
    const TickResult& out = drive.to(mm(x, 0, -2));
    ASSERT_NEAR(out.force.z, 2.0, 1e-9);
    if (x < 0.999) {
      ASSERT_NEAR(out.force.x, -x, 1e-9) << "sticks";
    } else if (x > 1.001) {
      ASSERT_NEAR(out.force.x, -0.6, 1e-6) << "slides";
      slid = true;
    }
  }
  EXPECT_TRUE(slid);
  // At rest it sticks again, and breaks away at the static cone.
  (void)drive.to(drive.hip());
  const double stuck = drive.hip().x * 1e3 - 0.6;  // where the proxy is, mm
  for (double x = stuck + 0.65; x < stuck + 0.99; x += 0.05) {
    ASSERT_NEAR(drive.to(mm(x, 0, -2)).force.x, -(x - stuck), 1e-6)
        << "sticks up to the static cone";
  }
  ASSERT_NEAR(drive.to(mm(stuck + 1.05, 0, -2)).force.x, -0.6, 1e-6);
}

}  // namespace
}  // namespace palpate::test
