// The local problem against an independent solver: Dykstra's cyclic projections, which converge to
// the projection onto an intersection of half-spaces whatever the planes are, and the conditions of
// the minimum.

#include "palpate/contact/planes.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

Vec3 dykstra(const Vec3& wish, const std::vector<Plane>& planes, int rounds) {
  Vec3 x = wish;
  std::vector<Vec3> left(planes.size(), Vec3(0.0));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const Vec3 y = x + left[i];
      const double beyond = -planes[i].gap - glm::dot(planes[i].normal, y);
      x = beyond > 0.0 ? y + beyond * planes[i].normal : y;
      left[i] = y - x;
    }
  }
  return x;
}

/// Feasible, stationary, complementary, and consistently reported: these conditions characterize
/// the unique minimum.
void expectOptimal(const Vec3& wish, const std::vector<Plane>& planes, const PlaneSolution& s,
                   double tolerance) {
  for (const Plane& plane : planes) {
    EXPECT_GE(glm::dot(plane.normal, s.step) + plane.gap, -tolerance);
  }
  Vec3 rebuilt = wish;
  ASSERT_LE(s.count, 3);
  for (int i = 0; i < s.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Plane& plane = planes[static_cast<std::size_t>(s.plane[k])];
    EXPECT_GE(s.multiplier[k], 0.0);
    EXPECT_NEAR(glm::dot(plane.normal, s.step) + plane.gap, 0.0, tolerance)
        << "holds what it touches";
    rebuilt += s.multiplier[k] * plane.normal;
  }
  EXPECT_LT(glm::length(rebuilt - s.step), tolerance);
}

TEST(ClosestStep, RandomPlanesAgainstDykstra) {
  Random random(11);
  int by_count[4] = {};
  int compared = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<Plane> planes(static_cast<std::size_t>(1 + trial % 8));
    for (Plane& plane : planes) {
      // In half of the trials the planes pass through the point, as walls in contact do.
      plane = {random.direction(), trial % 2 == 0 ? 0.0 : random.uniform(0.0, 1.0)};
    }
    const Vec3 wish = 2.0 * random.uniform(0.0, 1.0) * random.direction();
    const PlaneSolution s = closestStep(wish, planes);
    ++by_count[s.count];
    // Multipliers grow like 1 / sin of the angle between planes: the tolerance covers 1e-16 over
    // the square of 1e-3 rad.
    expectOptimal(wish, planes, s, 1e-9);
    const Vec3 other = dykstra(wish, planes, 400);
    double unfinished = 0.0;
    for (const Plane& plane : planes) {
      unfinished = std::max(unfinished, -plane.gap - glm::dot(plane.normal, other));
    }
    // Cyclic projections are slow at sharp edges; where they converged, the result is the same
    // point.
    if (unfinished < 1e-9) {
      ++compared;
      EXPECT_LE(glm::length(s.step - other), 1e-4);
    }
    // With all gaps >= 0 the zero step is permitted, so the minimum is never farther than that.
    EXPECT_LE(glm::length(s.step - wish), glm::length(wish) * (1.0 + 1e-6));
  }
  for (int count = 0; count <= 3; ++count) EXPECT_GT(by_count[count], 100) << count;
  EXPECT_GT(compared, 3000);
}

TEST(ClosestStep, ClosedForms) {
  const Plane floor{Vec3(0, 0, 1), 0.0};
  const Plane left{Vec3(1, 0, 0), 0.0};
  const Plane front{Vec3(0, 1, 0), 0.0};
  struct Row {
    Vec3 wish;
    std::vector<Plane> planes;
    Vec3 step;
    int count;
  };
  const Plane raised{Vec3(0, 0, 1), -0.25};  // already a quarter beyond it
  const Plane far_floor{Vec3(0, 0, 1), 0.5};
  for (const Row& row : {
           Row{Vec3(1, 2, 3), {}, Vec3(1, 2, 3), 0},
           Row{Vec3(1, 2, 3), {floor}, Vec3(1, 2, 3), 0},
           Row{Vec3(1, 2, -3), {floor}, Vec3(1, 2, 0), 1},
           Row{Vec3(0, 0, 0), {raised}, Vec3(0, 0, 0.25), 1},
           Row{Vec3(1, 0, -3), {far_floor}, Vec3(1, 0, -0.5), 1},
           Row{Vec3(-1, 2, -3), {floor, left}, Vec3(0, 2, 0), 2},
           Row{Vec3(-1, -2, -3), {floor, left, front}, Vec3(0, 0, 0), 3},
           Row{Vec3(-1, -2, -3), {far_floor, left, front}, Vec3(0, 0, -0.5), 3},
       }) {
    const PlaneSolution s = closestStep(row.wish, row.planes);
    EXPECT_LT(glm::length(s.step - row.step), 1e-15);
    EXPECT_EQ(s.count, row.count);
    expectOptimal(row.wish, row.planes, s, 1e-15);
  }
}

TEST(ClosestStep, TheSameWallTwiceActsAsOne) {
  Random random(5);
  for (const double apart : {0.0, 1e-12, 1e-9, 1e-7}) {
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 n = random.direction();
      const Vec3 m = glm::normalize(n + apart * random.direction());
      const Vec3 wish = -0.01 * n + 0.003 * random.direction();
      const std::vector<Plane> planes{{n, 0.0}, {m, 0.0}, {n, 1e-12}, {m, 0.0}};
      const PlaneSolution s = closestStep(wish, planes);
      double load = 0.0;
      for (int i = 0; i < s.count; ++i) load += s.multiplier[static_cast<std::size_t>(i)];
      const double depth = -glm::dot(n, wish);
      EXPECT_NEAR(load, depth, 1e-5 * depth) << apart << ": felt once, not twice";
      // Walls that come close to each other may stop the slide along the sliver between them, never
      // lengthen it.
      EXPECT_LE(glm::length(s.step), 0.0031) << apart;
      for (const Plane& plane : planes) {
        EXPECT_GE(glm::dot(plane.normal, s.step) + plane.gap, -1e-9 * depth);
      }
    }
  }
}

TEST(ClosestStep, OpposingPlanes) {
  const Plane up{Vec3(0, 0, 1), 0.1};
  const Plane down{Vec3(0, 0, -1), 0.2};
  const std::vector<Plane> slot{up, down};
  EXPECT_LT(glm::length(closestStep(Vec3(1, 0, -3), slot).step - Vec3(1, 0, -0.1)), 1e-15);
  EXPECT_LT(glm::length(closestStep(Vec3(1, 0, 3), slot).step - Vec3(1, 0, 0.2)), 1e-15);
  // No room at all: rounding has closed the slot. The point stays, and one of the planes holds it.
  const std::vector<Plane> shut{{Vec3(0, 0, 1), -1e-12}, {Vec3(0, 0, -1), -1e-12}};
  const PlaneSolution s = closestStep(Vec3(0, 0, -0.01), shut);
  EXPECT_LT(glm::length(s.step), 1e-11);
  ASSERT_EQ(s.count, 1);
  EXPECT_EQ(s.plane[0], 0);
  EXPECT_NEAR(s.multiplier[0], 0.01, 1e-11);
  // Closed exactly: tangential motion is still free.
  const std::vector<Plane> tight{{Vec3(0, 0, 1), 0.0}, {Vec3(0, 0, -1), 0.0}};
  EXPECT_LT(glm::length(closestStep(Vec3(0.02, 0, -0.01), tight).step - Vec3(0.02, 0, 0)), 1e-15);
}

TEST(ClosestStep, TakesTheFirstEightPlanes) {
  std::vector<Plane> planes(kMaxPlanes, Plane{Vec3(0, 0, 1), 5.0});
  planes.push_back({Vec3(0, 0, 1), 0.0});
  EXPECT_EQ(closestStep(Vec3(0, 0, -1), planes).count, 0);
  planes[kMaxPlanes - 1].gap = 0.0;
  EXPECT_EQ(closestStep(Vec3(0, 0, -1), planes).count, 1);
}

TEST(ClosestStep, ScalesFromNanometersToMeters) {
  Random random(3);
  for (const double scale : {1e-9, 1e-6, 1e-3, 1.0, 1e3}) {
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<Plane> planes(5);
      for (Plane& plane : planes) plane = {random.direction(), scale * random.uniform(0.0, 0.5)};
      const Vec3 wish = scale * random.direction();
      expectOptimal(wish, planes, closestStep(wish, planes), 1e-9 * scale);
    }
  }
}

}  // namespace
}  // namespace palpate::test
