// What the source paper's algorithm does wrong where the constraint renderer does not: it drifts, swings in
// hollows; and what it does right: the crossing point of its figure 2.1.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/primitives.h"
#include "support/oracle/closed_forms.h"

namespace palpate::test {
namespace {

/// Degrees between force and its truth after one turn about a ball of 50 mm, `share` R deep.
double driftOf(RendererKind kind, double share) {
  const double radius = 0.05;
  const double rho = radius * (1.0 - share);
  Drive drive(sceneOfSolid(sphere(Vec3(0.0), radius)), kind);
  (void)drive.walk(Vec3(radius * 1.02, 0, 0));
  (void)drive.walk(Vec3(rho, 0, 0));
  const double step = 0.2e-3 / rho;
  for (double angle = 0.0; angle < 2.0 * std::numbers::pi; angle += step) {
    (void)drive.to(rho * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  const Vec3 truth = drive.hip();
  return std::atan2(glm::length(glm::cross(drive.last().force, truth)),
                    glm::dot(drive.last().force, truth)) /
         kDegree;
}

TEST(HardPaper, DriftsOnABallTheMoreTheDeeper) {
  const double shallow = driftOf(RendererKind::kPaper, 0.02);
  EXPECT_GT(shallow, 7.2);
  EXPECT_LT(shallow, 9.5);
  EXPECT_GT(driftOf(RendererKind::kPaper, 0.1), 36.0);
  for (const double share : {0.02, 0.1, 0.5}) {
    EXPECT_LE(driftOf(RendererKind::kConstraint, share), 1e-6) << share;
  }
}

struct Swing {
  double force = 0.0;  ///< [N] peak to peak of the worst component over the last half
  double depth = 0.0;  ///< [m] at which the hand came to rest
};

/// A hand that trembles by a micrometer, `share` R beyond the wall of a hollow of radius R.
Swing swingIn(RendererKind kind, double share) {
  const double radius = 0.005;
  const double rho = radius * (1.0 + share);
  Material wall;
  wall.stiffness = 3000.0;
  Drive drive(sceneOfSolid(sphere(Vec3(0.0), radius), true, wall), kind);
  (void)drive.to(Vec3(0.0));
  (void)drive.walk(Vec3(rho, 0, 0), 0.1e-3);
  Vec3 lo(kInfinity);
  Vec3 hi(-kInfinity);
  for (int i = 0; i < 1000; ++i) {
    const double phase = 0.05 * i;
    const Vec3 f = drive.to(Vec3(rho, 1e-6 * std::sin(phase), 1e-6 * std::cos(phase))).force;
    if (i < 500) continue;
    lo = glm::min(lo, f);
    hi = glm::max(hi, f);
  }
  const Vec3 swing = hi - lo;
  return {std::max({swing.x, swing.y, swing.z}), rho - radius};
}

TEST(HardPaper, HollowsAreSteadyByTheConstraintRenderer) {
  // kappa d of 0.5 to 20. The truth turns by 1 um / rho: K d times that, both ways, and nothing else.
  for (const double share : {0.5, 1.0, 2.0, 4.0, 20.0}) {
    const Swing swing = swingIn(RendererKind::kConstraint, share);
    const double truth = 2.0 * 3000.0 * swing.depth * 1e-6 / (0.005 + swing.depth);
    EXPECT_LE(swing.force, 1.001 * truth + 1e-9) << share;
  }
}

TEST(HardPaper, PrintsItsSwingInHollows) {
  for (const double share : {0.5, 1.0, 2.0, 4.0, 20.0}) {
    std::printf("kappa d %4.1f: %g N\n", share, swingIn(RendererKind::kPaper, share).force);
  }
}

TEST(HardPaper, Figure21TheCrossingPointNotTheClosest) {
  // A convex surface met far off its normal: the hand goes along x through a ball, 30 mm above its center.
  // The closest point lies ahead of the hand (60 degrees up); the path came in at the side.
  const double radius = 0.05;
  const Vec3 from = mm(-60, 30, 0);
  const Vec3 to = mm(-12, 30, 0);
  const Vec3 crossing = mm(-40, 30, 0);
  const Vec3 closest = radius * glm::normalize(to);
  ASSERT_GT(glm::length(closest - crossing), 0.02);
  // In one tick the paper has the crossing point ...
  Drive paper(sceneOfSolid(sphere(Vec3(0.0), radius)), RendererKind::kPaper);
  (void)paper.to(from);
  EXPECT_TRUE(isNear(paper.to(to).proxy, crossing, 2e-6));
  // ... and so does a rule that forgets the path not: the constraint renderer goes through it, on the side
  // where the hand came in, and slides on from there to the one nearest point of this convex surface.
  Drive constraint(sceneOfSolid(sphere(Vec3(0.0), radius)));
  (void)constraint.to(from);
  EXPECT_TRUE(isNear(constraint.to(to).proxy, closest, 1e-9));
}

TEST(HardPaper, Figure21WhereTheClosestPointIsWrong) {
  // The case the figure warns of: a flat body entered through its wide face, so deep that the far face is
  // the closest. The path decides for both renderers; the closest point would push the hand out behind.
  const FieldPtr plate = box(Vec3(0.0), mm(200, 200, 20));
  const Vec3 from = mm(0, 0, 15);
  const Vec3 to = mm(4, 0, -6);
  for (const RendererKind kind : {RendererKind::kPaper, RendererKind::kConstraint}) {
    Drive drive(sceneOfSolid(plate), kind);
    (void)drive.to(from);
    const TickResult& out = drive.to(to);
    EXPECT_NEAR(out.proxy.z, 0.01, 2e-6);
    EXPECT_TRUE(isNear(out.force, Vec3(0, 0, kDefaultK * 0.016), 2e-6 * kDefaultK));
    const testing::Minima faces =
        testing::boxMinima(to, mm(-100, -100, -10), mm(100, 100, 10), testing::Held::kOutside);
    EXPECT_LT(testing::nearestTo(faces, to).z, 0.0) << "the closest point is on the other side";
  }
}

}  // namespace
}  // namespace palpate::test
