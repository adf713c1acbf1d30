// Curved walls against the oracle: the proxy is where |x - P| is smallest, to 1e-6 of the depth,
// outside and in hollows, whatever the metric of the field.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/hard_judge.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"
#include "support/implicit_ellipsoid.h"

namespace palpate::test {
namespace {

/// The oracle runs at every tick, which takes 0.05 to 2 ms.
int strokeTicks() { return std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 20'000 : 600; }

struct Curved {
  const char* name;
  FieldPtr field;
  bool from_within;
  Vec3 free;      ///< [m] where the hand begins
  Vec3 lo, hi;    ///< [m] box between whose faces it wanders
  double speed;   ///< [m/s]
  int share = 1;  ///< judge 1 of this many ticks: where the curvature jumps the oracle takes 30 ms
  std::function<bool(const Vec3&)> judged{};
};

/// A smooth random walk between the faces of a box.
void wander(const Curved& c, int seed) {
  SCOPED_TRACE(::testing::Message()
               << c.name << (c.from_within ? " from within" : " from outside"));
  Judge judge(c.field, c.from_within);
  judge.onlyWhere(c.judged);
  Random random(static_cast<std::uint64_t>(seed));
  const auto on_the_box = [&] {
    Vec3 q = random.in({c.lo, c.hi});
    const auto axis = static_cast<int>(random.uniform(0.0, 3.0));
    q[axis] = random.uniform(0.0, 1.0) < 0.5 ? c.lo[axis] : c.hi[axis];
    return q;
  };
  judgeSmoothWay(judge, c.free, {c.speed, 0.9, strokeTicks() / c.share}, on_the_box);
  if (::testing::Test::HasFatalFailure()) return;
  EXPECT_GT(judge.contacts(), judge.ticks() / 5);
  EXPECT_LT(judge.ambiguous(), judge.ticks() / 5);
}

TEST(HardCurved, EllipsoidExact) {
  const FieldPtr field = ellipsoid(Vec3(0.0), mm(30, 20, 10));
  wander({"ellipsoid", field, false, mm(40, 0, 0), mm(-26, -17, -8), mm(26, 17, 8), 0.2}, 1);
  wander({"ellipsoid within", field, true, mm(0, 0, 0), mm(-35, -25, -15), mm(35, 25, 15), 0.2}, 2);
}

TEST(HardCurved, EllipsoidAsAQuadric) {
  const FieldPtr field = testing::implicitEllipsoid(Vec3(0.0), mm(30, 20, 10));
  wander({"quadric", field, false, mm(40, 0, 0), mm(-26, -17, -8), mm(26, 17, 8), 0.2}, 3);
  wander({"quadric within", field, true, mm(0, 0, 0), mm(-35, -25, -15), mm(35, 25, 15), 0.2}, 4);
}

TEST(HardCurved, Hyperboloid) {
  // x^2 + y^2 - z^2 = (20 mm)^2: a waist with curvatures of both signs; felt from both sides.
  QuadricCoefficients c;
  c.xx = c.yy = 1.0;
  c.zz = -1.0;
  c.constant = -0.02 * 0.02;
  const FieldPtr field = quadric(Vec3(0.0), c, 0.2);
  wander({"hyperboloid", field, false, mm(50, 0, 0), mm(5, -20, -30), mm(30, 20, 30), 0.2}, 5);
  wander({"hyperboloid within", field, true, mm(0, 0, 0), mm(-35, -35, -20), mm(35, 35, 20), 0.2},
         6);
}

TEST(HardCurved, Torus) {
  const FieldPtr field = torus(Vec3(0.0), Vec3(0, 0, 1), 0.03, 0.01);
  const auto within_reach = [](const Vec3& p) {
    return std::hypot(std::hypot(p.x, p.y) - 0.03, p.z) > 0.1 * 0.01;
  };
  wander(
      {"torus", field, false, mm(50, 0, 0), mm(-36, -36, -7), mm(36, 36, 7), 0.2, 1, within_reach},
      7);
  wander({"torus within", field, true, mm(30, 0, 0), mm(-45, -45, -15), mm(45, 45, 15), 0.2}, 8);
}

TEST(HardCurved, Capsule) {
  const FieldPtr field = capsule(mm(-20, 0, 0), mm(20, 0, 0), 0.01);
  wander({"capsule", field, false, mm(0, 20, 0), mm(-26, -7, -7), mm(26, 7, 7), 0.8, 4}, 9);
  wander({"capsule within", field, true, mm(0, 0, 0), mm(-35, -15, -15), mm(35, 15, 15), 0.8, 4},
         10);
}

TEST(HardCurved, RoundedBoxWithinByClosedForm) {
  // Beyond the wall of a rounded room the nearest point is unique: from the core box outward by the
  // rounding radius. Its curvature jumps where faces, edges and corners meet.
  const double r = 0.005;
  const Vec3 core = mm(25, 15, 5);
  Drive drive(sceneOfSolid(roundedBox(Vec3(0.0), mm(60, 40, 20), r), true));
  (void)drive.to(Vec3(0.0));
  Random random(11);
  Vec3 p(0.0);
  Vec3 goal(0.0);
  int contacts = 0;
  double worst = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    if (glm::length(goal - p) < 2e-3) goal = random.in({mm(-40, -30, -20), mm(40, 30, 20)});
    p += 1e-3 * glm::normalize(goal - p);
    const TickResult& out = drive.to(p);
    const Vec3 q = glm::clamp(p, -core, core);
    const double beyond = glm::length(p - q);
    const Vec3 z = beyond > r ? q + (r / beyond) * (p - q) : p;
    const double depth = glm::length(z - p);
    ASSERT_TRUE(isNear(out.proxy, z, 1e-6 * depth + 4e-9 * r)) << i;
    ASSERT_TRUE(isNear(out.force / kDefaultK, z - p, 1e-6 * depth)) << i;
    if (depth > 0.0) {
      ++contacts;
      worst = std::max(worst, glm::length(out.force / kDefaultK - (z - p)) / depth);
    }
  }
  EXPECT_GT(contacts, 4000);
  EXPECT_LE(worst, 1e-6);
}

TEST(HardCurved, RoundedBoxFromOutside) {
  const FieldPtr field = roundedBox(Vec3(0.0), mm(60, 40, 20), 0.005);
  wander({"rounded box", field, false, mm(50, 0, 0), mm(-32, -22, -12), mm(32, 22, 12), 1.6, 8},
         12);
}

}  // namespace
}  // namespace palpate::test
