// Edges, corners, grooves and creases, from both sides, against the oracle and closed forms.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/oracle/closed_forms.h"

namespace palpate::test {
namespace {

int walkTicks() { return std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 20'000 : 800; }

struct Walk {
  const char* name;
  FieldPtr field;
  bool from_within;
  Vec3 free;  ///< [m] where the hand begins, and to which it returns
  Vec3 lo, hi;
  double speed = 0.2;           ///< [m/s]
  double oracle_step = 200e-6;  ///< [m]
  std::function<bool(const Vec3&)> judged{};
  double grant = 1.0;
};

/// Judges a walk between random points of a box, and now and then out to the free point.
void judgeWalk(const Walk& w, int seed) {
  SCOPED_TRACE(::testing::Message()
               << w.name << (w.from_within ? " from within" : " from outside"));
  Judge judge(w.field, w.from_within);
  judge.stepOracleBy(w.oracle_step);
  judge.onlyWhere(w.judged);
  judge.grant(w.grant);
  judgeWalk(judge, w.free, {w.lo, w.hi}, w.speed, seed, walkTicks());
}

TEST(HardEdges, BoxFromBothSides) {
  const FieldPtr solid = box(Vec3(0.0), mm(60, 40, 20));
  judgeWalk({"box", solid, false, mm(45, 30, 20), mm(-33, -23, -13), mm(33, 23, 13), 1.0}, 1);
  judgeWalk({"room", solid, true, mm(0, 0, 0), mm(-36, -26, -16), mm(36, 26, 16), 1.0}, 2);
}

TEST(HardEdges, TurnedBoxFromBothSides) {
  const Pose pose{rotationAbout(Vec3(1, 2, 3), 0.7), mm(3, 1, -2)};
  const FieldPtr solid = place(box(Vec3(0.0), mm(60, 40, 20)), pose);
  judgeWalk({"turned box", solid, false, mm(45, 40, 30), mm(-28, -28, -20), mm(28, 28, 20), 1.0},
            3);
  judgeWalk({"turned room", solid, true, mm(3, 1, -2), mm(-36, -36, -26), mm(36, 36, 26), 1.0}, 4);
}

TEST(HardEdges, CylinderRimsFromBothSides) {
  const FieldPtr solid = cylinder(Vec3(0.0), Vec3(1, 1, 0.3), 0.02, 0.03);
  judgeWalk({"can", solid, false, mm(30, 30, 30), mm(-22, -22, -20), mm(22, 22, 20), 1.0}, 5);
  judgeWalk({"within a can", solid, true, mm(0, 0, 0), mm(-28, -28, -25), mm(28, 28, 25), 1.0}, 6);
}

/// Air between two planes that meet at 0, `degrees` apart, opening towards +z; its feature size is
/// 10 mm.
FieldPtr wedge(double degrees) {
  const double a = 0.5 * degrees * kDegree;
  return intersect({halfSpace(Vec3(0.0), Vec3(std::cos(a), 0, -std::sin(a))),
                    halfSpace(Vec3(0.0), Vec3(-std::cos(a), 0, -std::sin(a)))});
}

TEST(HardEdges, GrooveOfTenDegrees) {
  judgeWalk({"groove 10",
             wedge(10.0),
             true,
             mm(0, 0, 30),
             mm(-8, -10, -8),
             mm(8, 10, 25),
             0.5,
             200e-6,
             {},
             1.0 / std::sin(5.0 * kDegree)},
            7);
}

TEST(HardEdges, GrooveOfTenDegreesByClosedForm) {
  // Depths of up to 20 mm and any tilt: there is one minimum, so every tick is judged.
  const double a = 5.0 * kDegree;
  const Vec3 n1(-std::cos(a), 0, std::sin(a));
  const Vec3 n2(std::cos(a), 0, std::sin(a));
  Drive drive(sceneOfSolid(wedge(10.0), true));
  (void)drive.to(mm(0, 0, 30));
  Random random(8);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = random.in({mm(-20, -20, -20), mm(20, 20, 20)});
    // The way there may be long: a hand that jumps around, then rests.
    (void)drive.to(p);
    const Vec3 z = oracle::grooveMinima(p, Vec3(0.0), n1, n2).front();
    ASSERT_TRUE(isNear(drive.last().proxy, z, 1e-6 * glm::length(z - p) + 1e-9)) << i;
  }
}

TEST(HardEdges, FoldOfEveryAngle) {
  // The hand moves around a blade whose two sides are each tilted by half the angle: it is held on
  // either side, and released at the edge.
  for (const double degrees : {10.0, 90.0, 170.0}) {
    SCOPED_TRACE(degrees);
    judgeWalk(
        {"fold", wedge(degrees), false, mm(0, 0, -20), mm(-8, -10, -8), mm(8, 10, 20), 0.5, 20e-6},
        9);
  }
}

const FieldPtr kLeft = sphere(mm(-15, 0, 0), 0.025);
const FieldPtr kRight = sphere(mm(15, 0, 0), 0.025);

TEST(HardEdges, CreaseOfTwoBalls) {
  const FieldPtr both = unite({kLeft, kRight});
  judgeWalk({"two balls", both, false, mm(0, 40, 0), mm(-25, -16, -16), mm(25, 16, 16), 0.5, 200e-6,
             [](const Vec3& p) { return std::hypot(p.y, p.z) > 2e-3; }},
            10);
  judgeWalk({"within two balls", both, true, mm(0, 0, 0), mm(-45, -30, -30), mm(45, 30, 30), 0.5},
            11);
}

TEST(HardEdges, RimOfALens) {
  const FieldPtr lens = intersect({kLeft, kRight});
  judgeWalk({"lens", lens, false, mm(0, 40, 0), mm(-9, -19, -19), mm(9, 19, 19), 0.5}, 12);
  judgeWalk({"within a lens", lens, true, mm(0, 0, 0), mm(-15, -25, -25), mm(15, 25, 25), 0.5}, 13);
}

TEST(HardEdges, CornerOfThreeBalls) {
  // A dimple where three balls meet: the proxy rests on all three.
  std::vector<FieldPtr> balls;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 3.0;
    balls.push_back(sphere(0.012 * Vec3(std::cos(a), std::sin(a), 0), 0.02));
  }
  const FieldPtr three = unite(balls);
  judgeWalk({"three balls", three, false, mm(0, 0, 40), mm(-14, -14, 2), mm(14, 14, 16), 0.5}, 14);
}

TEST(HardEdges, BallTakenOutOfABox) {
  const FieldPtr bowl = subtract({box(Vec3(0.0), mm(60, 60, 30)), sphere(mm(0, 0, 20), 0.02)});
  judgeWalk({"bowl", bowl, false, mm(0, 0, 30), mm(-32, -32, -5), mm(32, 32, 20), 1.0}, 15);
}

}  // namespace
}  // namespace palpate::test
