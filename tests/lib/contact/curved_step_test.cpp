// The step in the metric of the walls' curvature, against the best result of all sets of planes
// that may hold it.

#include <gtest/gtest.h>

#include <vector>

#include "palpate/contact/planes.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Some symmetric matrix whose norm is about `size`.
Mat3 symmetric(Random& random, double size) {
  Mat3 out(0.0);
  for (int i = 0; i < 3; ++i) {
    const Vec3 n = random.direction();
    out += random.uniform(-size, size) * glm::outerProduct(n, n);
  }
  return out;
}

/// A quadratic problem on one plane: the objective and the constraints.
struct Problem {
  Vec3 wish;
  Mat3 metric;
  std::vector<Plane> planes;
  Vec3 base;  ///< a point of the plane
  Vec3 t1, t2;

  [[nodiscard]] double cost(const Vec3& p) const {
    return 0.5 * glm::dot(p, metric * p) - glm::dot(wish, p);
  }
  [[nodiscard]] double broken(const Vec3& p) const {
    double out = 0.0;
    for (const Plane& plane : planes) {
      out = std::max(out, -plane.gap - glm::dot(plane.normal, p));
    }
    return out;
  }
  /// The best point of base + span(directions); false if there is none.
  [[nodiscard]] bool bestIn(const Vec3& from, const std::vector<Vec3>& directions,
                            Vec3& out) const {
    // The cost along the directions: c'Mc / 2 - g.c.
    out = from;
    if (directions.empty()) return true;
    const Vec3 pull = wish - metric * from;
    if (directions.size() == 1) {
      const Vec3& d = directions[0];
      const double stiff = glm::dot(d, metric * d);
      if (!(stiff > 0.0)) return false;
      out += (glm::dot(d, pull) / stiff) * d;
      return true;
    }
    const Vec3& d = directions[0];
    const Vec3& e = directions[1];
    const double a = glm::dot(d, metric * d);
    const double b = glm::dot(d, metric * e);
    const double c = glm::dot(e, metric * e);
    const double det = a * c - b * b;
    if (!(det > 0.0)) return false;
    const double p = glm::dot(d, pull);
    const double q = glm::dot(e, pull);
    out += ((c * p - b * q) / det) * d + ((a * q - b * p) / det) * e;
    return true;
  }
  /// The smallest cost permitted, over all sets of at most two more planes that hold the point.
  [[nodiscard]] double least(double slack) const {
    double out = kInfinity;
    const auto look = [&](const Vec3& from, const std::vector<Vec3>& directions) {
      Vec3 p(0.0);
      if (bestIn(from, directions, p) && broken(p) <= slack) out = std::min(out, cost(p));
    };
    look(base, {t1, t2});
    const Vec3 normal = glm::cross(t1, t2);
    std::vector<std::pair<Vec3, Vec3>> lines;  // a point and the direction
    for (const Plane& plane : planes) {
      const Vec3 across = plane.normal - glm::dot(plane.normal, normal) * normal;
      const double square = glm::dot(across, across);
      if (square < 1e-12) continue;
      const double need = -plane.gap - glm::dot(plane.normal, base);
      lines.emplace_back(base + (need / square) * across,
                         glm::normalize(glm::cross(normal, across)));
      look(lines.back().first, {lines.back().second});
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 between = lines[j].first - lines[i].first;
        const Vec3 across = glm::cross(normal, lines[j].second);
        const double along = glm::dot(across, lines[i].second);
        if (std::fabs(along) < 1e-6) continue;
        look(lines[i].first + (glm::dot(across, between) / along) * lines[i].second, {});
      }
    }
    return out;
  }
};

TEST(CurvedStep, OnOneWallIsTheBestThatTheOthersAllow) {
  Random random(21);
  int curved = 0;
  int by_others = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    Problem problem;
    problem.planes.resize(static_cast<std::size_t>(1 + trial % 5));
    for (Plane& plane : problem.planes) plane = {random.direction(), random.uniform(0.0, 0.6)};
    problem.planes[0].gap = 0.0;
    problem.wish = random.uniform(0.2, 2.0) * random.direction();
    // Then the eigenvalues of 1 - bend are above 0.1, and the matrix is used unchanged.
    const Mat3 bend = symmetric(random, 0.3);
    const PlaneSolution first = closestStep(problem.wish, problem.planes);
    if (first.count != 1) continue;
    const CurvedStep step = curvedStep(problem.wish, problem.planes, first, bend, 0.02);
    ++curved;
    const Vec3& n = problem.planes[static_cast<std::size_t>(first.plane[0])].normal;
    tangentsOf(n, problem.t1, problem.t2);
    problem.base = glm::dot(n, first.step) * n;
    EXPECT_NEAR(glm::dot(n, step.step - first.step), 0.0, 1e-12) << "stays on its wall";
    EXPECT_LE(problem.broken(step.step), 1e-9) << trial;
    // Only the motion along the wall is free; the component across it is given, so the curvature
    // across does not count.
    problem.metric = Mat3(1.0) - bend;
    const Mat3 along = Mat3(1.0) - glm::outerProduct(n, n);
    problem.metric = along * problem.metric * along;
    const double least = problem.least(1e-9);
    EXPECT_LE(problem.cost(step.step), least + 1e-8) << trial;
    Vec3 alone(0.0);
    if (problem.bestIn(problem.base, {problem.t1, problem.t2}, alone)) {
      by_others += glm::length(alone - step.step) > 1e-6 ? 1 : 0;
    }
  }
  EXPECT_GT(curved, 3000);
  EXPECT_GT(by_others, 500) << "steps that other planes cut short";
}

TEST(CurvedStep, GoesDownhillWhereTheWallBendsTooMuch) {
  // A hand beyond the center of curvature in one direction: there the eigenvalue is replaced by its
  // magnitude.
  Random random(22);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 n = random.direction();
    Vec3 t1(0.0);
    Vec3 t2(0.0);
    tangentsOf(n, t1, t2);
    const double angle = random.uniform(0.0, 3.0);
    const Vec3 d = std::cos(angle) * t1 + std::sin(angle) * t2;
    const Vec3 e = glm::cross(n, d);
    const double low = random.uniform(-3.0, -0.1);
    const double high = random.uniform(0.1, 3.0);
    const Mat3 bend = Mat3(1.0) - low * glm::outerProduct(d, d) - high * glm::outerProduct(e, e);
    const std::vector<Plane> planes{{n, 0.0}};
    const Vec3 wish = -n + random.uniform(-1.0, 1.0) * d + random.uniform(-1.0, 1.0) * e;
    const CurvedStep step = curvedStep(wish, planes, closestStep(wish, planes), bend, 0.02);
    EXPECT_NEAR(step.lowest, low, 1e-12);
    EXPECT_NEAR(std::fabs(glm::dot(step.downhill, d)), 1.0, 1e-9);
    const Vec3 expected = (glm::dot(wish, d) / -low) * d + (glm::dot(wish, e) / high) * e;
    EXPECT_LT(glm::length(step.step - expected), 1e-9) << trial;
  }
}

TEST(CurvedStep, BetweenTwoWallsGoesAlongTheirCrease) {
  Random random(23);
  int seen = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<Plane> planes(static_cast<std::size_t>(2 + trial % 3));
    for (Plane& plane : planes) plane = {random.direction(), random.uniform(0.0, 0.6)};
    planes[0].gap = planes[1].gap = 0.0;
    const Vec3 wish = random.uniform(0.2, 2.0) * random.direction();
    const Mat3 bend = symmetric(random, 0.3);
    const PlaneSolution first = closestStep(wish, planes);
    if (first.count != 2) continue;
    ++seen;
    const CurvedStep step = curvedStep(wish, planes, first, bend, 0.02);
    const Vec3& a = planes[static_cast<std::size_t>(first.plane[0])].normal;
    const Vec3& b = planes[static_cast<std::size_t>(first.plane[1])].normal;
    const Vec3 t = glm::normalize(glm::cross(a, b));
    const double eigenvalue = 1.0 - glm::dot(t, bend * t);
    EXPECT_NEAR(step.lowest, eigenvalue, 1e-12);
    // The best step starts at the point `base` of the crease, and goes along the crease as far as
    // the curvature demands, or up to the first plane.
    const Vec3 base = first.step - glm::dot(t, first.step) * t;
    double lo = -kInfinity;
    double hi = kInfinity;
    for (const Plane& plane : planes) {
      const double rise = glm::dot(plane.normal, t);
      const double where = -(plane.gap + glm::dot(plane.normal, base)) / rise;
      if (rise > 1e-9) lo = std::max(lo, where);
      if (rise < -1e-9) hi = std::min(hi, where);
    }
    const double want = std::clamp(glm::dot(t, wish) / eigenvalue, lo, hi);
    EXPECT_LT(glm::length(step.step - (base + want * t)), 1e-9) << trial;
  }
  EXPECT_GT(seen, 400);
}

TEST(CurvedStep, FreeOrInACornerIsTheStepItself) {
  const Mat3 bend = Mat3(0.3);
  const std::vector<Plane> corner{{Vec3(1, 0, 0), 0.0}, {Vec3(0, 1, 0), 0.0}, {Vec3(0, 0, 1), 0.1}};
  const Vec3 in(-1.0, -2.0, -3.0);
  const PlaneSolution held = closestStep(in, corner);
  ASSERT_EQ(held.count, 3);
  EXPECT_LT(glm::length(curvedStep(in, corner, held, bend, 0.02).step - Vec3(0, 0, -0.1)), 1e-15);
  const Vec3 off(1.0, 2.0, 3.0);
  const PlaneSolution free = closestStep(off, corner);
  ASSERT_EQ(free.count, 0);
  EXPECT_EQ(curvedStep(off, corner, free, bend, 0.02).step, off);
}

}  // namespace
}  // namespace palpate::test
