// Faults of the source paper's algorithm that the constraint renderer does not have: it drifts, and
// it oscillates in hollows. And its merit: the crossing point of its figure 2.1.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/primitives.h"
#include "support/oracle/closed_forms.h"

namespace palpate::test {
namespace {

/// Angle [degrees] between the force and the true direction after one turn around a ball of 50 mm,
/// `share` R deep.
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

/// Smallest and largest magnitude of the force over a stroke at constant depth around a hollow of 5
/// mm, K = 3000 N/m, `share` R deep.
std::pair<double, double> forcesInHollow(RendererKind kind, double share) {
  const double radius = 0.005;
  const double rho = radius * (1.0 + share);
  Material wall;
  wall.stiffness = 3000.0;
  Drive drive(sceneOfSolid(sphere(Vec3(0.0), radius), true, wall), kind);
  (void)drive.to(Vec3(0.0));
  (void)drive.walk(Vec3(rho, 0, 0), 0.1e-3);
  double least = kInfinity;
  double most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double angle = 0.2e-3 / rho * i;
    const double force =
        glm::length(drive.to(rho * Vec3(std::cos(angle), std::sin(angle), 0)).force);
    least = std::min(least, force);
    most = std::max(most, force);
  }
  return {least, most};
}

TEST(HardPaper, InAHollowItsForceVanishesAlongAStroke) {
  for (const double share : {0.5, 2.0, 10.0}) {
    const double truth = 3000.0 * 0.005 * share;
    EXPECT_LT(forcesInHollow(RendererKind::kPaper, share).first, 0.1 * truth) << share;
    const auto [least, most] = forcesInHollow(RendererKind::kConstraint, share);
    EXPECT_NEAR(least, truth, 1e-6 * truth) << share;
    EXPECT_NEAR(most, truth, 1e-6 * truth) << share;
  }
}

TEST(HardPaper, Figure21TheCrossingPointNotTheClosest) {
  // A convex surface met far from its normal: the hand moves along x through a ball, 30 mm above
  // its center. The closest point is ahead of the hand (60 degrees up); the path entered at the
  // side.
  const double radius = 0.05;
  const Vec3 from = mm(-60, 30, 0);
  const Vec3 to = mm(-12, 30, 0);
  const Vec3 crossing = mm(-40, 30, 0);
  const Vec3 closest = radius * glm::normalize(to);
  ASSERT_GT(glm::length(closest - crossing), 0.02);
  // In one tick the paper's renderer finds the crossing point.
  Drive paper(sceneOfSolid(sphere(Vec3(0.0), radius)), RendererKind::kPaper);
  (void)paper.to(from);
  EXPECT_TRUE(isNear(paper.to(to).proxy, crossing, 2e-6));
  // A rule that forgets the path would not find it. The constraint renderer's proxy passes this
  // point, on the side where the hand entered, and slides on from there to the one nearest point of
  // this convex surface.
  Drive constraint(sceneOfSolid(sphere(Vec3(0.0), radius)));
  (void)constraint.to(from);
  EXPECT_TRUE(isNear(constraint.to(to).proxy, closest, 1e-9));
}

TEST(HardPaper, Figure21WhereTheClosestPointIsWrong) {
  // The case of which the figure warns: a flat body entered through its wide face, so deep that the
  // far face is the closest. The path decides for both renderers; the closest point would push the
  // hand out at the back.
  const FieldPtr plate = box(Vec3(0.0), mm(200, 200, 20));
  const Vec3 from = mm(0, 0, 15);
  const Vec3 to = mm(4, 0, -6);
  for (const RendererKind kind : {RendererKind::kPaper, RendererKind::kConstraint}) {
    Drive drive(sceneOfSolid(plate), kind);
    (void)drive.to(from);
    const TickResult& out = drive.to(to);
    EXPECT_NEAR(out.proxy.z, 0.01, 2e-6);
    EXPECT_TRUE(isNear(out.force, Vec3(0, 0, kDefaultK * 0.016), 2e-6 * kDefaultK));
    const oracle::Minima faces =
        oracle::boxMinima(to, mm(-100, -100, -10), mm(100, 100, 10), oracle::Held::kOutside);
    EXPECT_LT(oracle::nearestTo(faces, to).z, 0.0) << "the closest point is on the other side";
  }
}

}  // namespace
}  // namespace palpate::test
