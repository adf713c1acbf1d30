// Edges, corners and rims felt from inside: several faces hold the proxy at once, and the force is
// exact.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/drive.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kK = 1000.0;  // [N/m], the default wall

std::string room(const std::string& field) {
  return "palpate: 1\nlength: mm\nlayers: [{name: room, inside: {" + field +
         "}}]\nstart: {region: room}\n";
}

TEST(InsideCorners, BoxFacesEdgesAndCorners) {
  const Vec3 half(0.03, 0.02, 0.01);
  Drive drive(sceneOf(room("box: {center: [0, 0, 0], size: [60, 40, 20]}")));
  (void)drive.to(Vec3(0.0));
  Random random(31);
  int held[4] = {};
  Vec3 p(0.0);
  Vec3 heading = random.direction();
  for (int i = 0; i < 20000; ++i) {
    // 1 mm a tick, inside and around the box, up to 10 mm beyond it.
    heading = glm::normalize(heading + 0.3 * random.direction());
    const Vec3 next = p + 1e-3 * heading;
    p = glm::clamp(next, -half - Vec3(0.01), half + Vec3(0.01));
    if (p != next) heading = -heading;
    const Vec3 inside = glm::clamp(p, -half, half);
    const TickResult& out = drive.to(p);
    int walls = 0;
    for (int axis = 0; axis < 3; ++axis) walls += inside[axis] != p[axis] ? 1 : 0;
    ++held[walls];
    ASSERT_TRUE(isNear(out.proxy, inside, 1e-9)) << "tick " << i << ", " << walls << " walls";
    // The proxy stands slightly off the walls. The force is measured from the walls, to rounding.
    ASSERT_TRUE(isNear(out.force, kK * (inside - p), 1e-11)) << "tick " << i << ", " << walls;
    ASSERT_EQ(out.contact, walls > 0) << "tick " << i;
  }
  for (const int count : held) EXPECT_GT(count, 300);
}

TEST(InsideCorners, CylinderRims) {
  Drive drive(
      sceneOf(room("cylinder: {center: [0, 0, 0], axis: [0, 0, 1], radius: 20, height: 30}")));
  (void)drive.to(Vec3(0.0));
  Random random(32);
  Vec3 p(0.0);
  Vec3 heading = random.direction();
  int rims = 0;
  for (int i = 0; i < 20000; ++i) {
    heading = glm::normalize(heading + 0.3 * random.direction());
    const Vec3 next = p + 0.5e-3 * heading;
    const double rho = std::hypot(next.x, next.y);
    const double bound = std::min(1.0, 0.028 / std::max(rho, 1e-12));
    p = Vec3(next.x * bound, next.y * bound, std::clamp(next.z, -0.02, 0.02));
    if (p != next) heading = -heading;
    const double r = std::hypot(p.x, p.y);
    const double pulled = std::min(1.0, 0.02 / std::max(r, 1e-12));
    const Vec3 inside(p.x * pulled, p.y * pulled, std::clamp(p.z, -0.015, 0.015));
    if (pulled < 1.0 && inside.z != p.z) ++rims;
    const TickResult& out = drive.to(p);
    ASSERT_TRUE(isNear(out.proxy, inside, 1e-8)) << i;
    ASSERT_TRUE(isNear(out.force, kK * (inside - p), 1e-5)) << i;
  }
  EXPECT_GT(rims, 1000);
}

TEST(InsideCorners, ConcaveCreaseOfTwoBallsFromOutside) {
  // The ring where two balls meet holds a hand that presses between them: at x = 0, with the radius
  // of the ring.
  Drive drive(
      sceneOf(room("complement: {union: [{sphere: {center: [-15, 0, 0], radius: 25}}, "
                   "{sphere: {center: [15, 0, 0], radius: 25}}]}")));
  const double ring = 0.02;
  (void)drive.to(mm(0, 30, 0));
  for (double angle = 0.0; angle < 6.0; angle += 0.01) {
    const Vec3 u(0, std::cos(angle), std::sin(angle));
    const Vec3 p = (ring - 0.003) * u + Vec3(0.0005 * std::sin(7 * angle), 0, 0);
    const TickResult& out = drive.to(p);
    ASSERT_TRUE(isNear(out.proxy, ring * u, 1e-9)) << angle;
    ASSERT_TRUE(isNear(out.force, kK * (ring * u - p), 1e-6)) << angle;
  }
}

TEST(InsideCorners, VGroovesOfEveryAngle) {
  for (const double degrees : {10.0, 45.0, 90.0, 170.0}) {
    const double a = degrees * 0.5 * 0.017453292519943295;
    // The groove opens towards +z: its walls are tilted from that direction by a, and the air is
    // between them.
    const auto plane = [&](double side) {
      return "{half_space: {point: [0, 0, 0], normal: [" + std::to_string(side * std::cos(a)) +
             ", 0, " + std::to_string(-std::sin(a)) + "]}}";
    };
    Drive drive(sceneOf(room("intersection: [" + plane(1) + ", " + plane(-1) + "]")));
    (void)drive.to(mm(0, 0, 20));
    const TickResult& down = drive.walk(mm(0, 0, -3));
    EXPECT_TRUE(isNear(down.force, Vec3(0, 0, 3), 1e-5)) << degrees;
    // The hand goes along the groove, moving slightly to the sides.
    for (double y = 0.0; y < 20.0; y += 0.5) {
      // The bottom holds the proxy while P is off the middle by less than the walls' normals
      // permit: 3 / tan a.
      const double lean = 0.9 * 3.0 / std::tan(a) * std::sin(y);
      const TickResult& out = drive.to(mm(lean, y, -3));
      ASSERT_TRUE(isNear(out.proxy, mm(0, y, 0), 1e-8)) << degrees << " " << y;
      ASSERT_TRUE(isNear(out.force, Vec3(-lean, 0, 3), 1e-9)) << degrees << " " << y;
    }
  }
}

/// Two solid quadrants that meet at their edges, and two of air. If both walls of one air quadrant
/// hold the proxy, the proxy is at a point of the other air quadrant as well, where the hand is.
TEST(InsideCorners, QuadrantsOfAirThatMeetAtTheirEdgeAreOneRegion) {
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields:
  right: {half_space: {point: [0, 0, 0], normal: [-1, 0, 0]}}
  above: {half_space: {point: [0, 0, 0], normal: [0, 0, -1]}}
layers:
  - name: both
    inside: {union: [{intersection: [right, above]}, {intersection: [{complement: right}, {complement: above}]}]}
)"));
  (void)drive.to(mm(2, 0, -2));
  (void)drive.walk(mm(2, 0, 0.5));
  for (double x = 2.0; x > -2.0; x -= 0.03) {
    const TickResult& out = drive.to(mm(x, 0, 0.5));
    const Vec3 held = mm(x, 0, x > 0.0 ? 0.0 : 0.5);
    if (std::fabs(x) < 0.05) continue;  // in the tick that reaches the edge, or the next one
    ASSERT_TRUE(isNear(out.proxy, held, 1e-9)) << x;
    ASSERT_TRUE(isNear(out.force, kK * (held - mm(x, 0, 0.5)), 1e-6)) << x;
  }
}

}  // namespace
}  // namespace palpate::test
