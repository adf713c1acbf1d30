// A field's parts: in a cell they give the field's values, with fewer of its operands.

#include "bake/field_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::vdb {
namespace {

using palpate::test::Random;

const Box3 kRegion{Vec3(-60e-3), Vec3(60e-3)};

FieldPtr leafOf(Random& random) {
  const Vec3 at = random.in(kRegion);
  const double size = random.uniform(3e-3, 30e-3);
  switch (static_cast<int>(random.uniform(0.0, 7.0))) {
    case 0:
      return sphere(at, size);
    case 1:
      return box(at, Vec3(size, 2.0 * size, 0.5 * size));
    case 2:
      return torus(at, random.direction(), size, 0.3 * size);
    case 3:
      return halfSpace(at, random.direction());
    case 4:
      return smoothUnite({sphere(at, size), sphere(at + Vec3(size), size)}, 0.5 * size);
    case 5:
      return gyroid(at, size);
    default:
      return cylinder(at, random.direction(), size, size);
  }
}

/// A random tree of up to `depth` levels of CSG.
FieldPtr treeOf(Random& random, int depth) {
  if (depth == 0) return leafOf(random);
  const auto some = [&] {
    std::vector<FieldPtr> operands;
    const int count = 1 + static_cast<int>(random.uniform(0.0, 5.0));
    for (int n = 0; n < count; ++n) operands.push_back(treeOf(random, depth - 1));
    return operands;
  };
  switch (static_cast<int>(random.uniform(0.0, 5.0))) {
    case 0:
      return unite(some());
    case 1:
      return intersect(some());
    case 2:
      return subtract(some());
    case 3:
      return complement(treeOf(random, depth - 1));
    default:
      return place(treeOf(random, depth - 1),
                   {rotationAbout(random.direction(), random.uniform(0.0, 3.0)),
                    random.in({Vec3(-10e-3), Vec3(10e-3)})});
  }
}

Vec3 inBall(Random& random, const Vec3& center, double radius) {
  return center + random.direction() * (radius * std::cbrt(random.uniform(0.0, 1.0)));
}

PointBatch batchIn(Random& random, const Vec3& center, double radius) {
  PointBatch points{};
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    const Vec3 p = inBall(random, center, radius);
    points.x[n] = p.x;
    points.y[n] = p.y;
    points.z[n] = p.z;
  }
  return points;
}

TEST(FieldParts, SayWhatTheFieldSaysInTheirBall) {
  Random random(7);
  std::size_t before = 0, after = 0;
  for (int round = 0; round < 300; ++round) {
    const FieldPtr field = treeOf(random, 1 + round % 3);
    const FieldParts parts(*field);
    before += parts.whole().nodes.size();
    // Ever smaller balls, each part narrowed from the one before.
    FieldPart part = parts.whole();
    Vec3 center = random.in(kRegion);
    double radius = 40e-3;
    for (int level = 0; level < 4; ++level) {
      FieldPart next;
      const ValueRange range = parts.narrow(part, center, radius, kInfinity, next);
      const PointBatch points = batchIn(random, center, radius);
      ValueBatch values{};
      parts.values(next, points, values);
      for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
        const FieldSample truth = field->sample(points[n]);
        ASSERT_EQ(values[n], truth.value) << round << " " << level;
        ASSERT_EQ(parts.value(next, points[n]), truth.value);
        const FieldSample sample = parts.sample(next, points[n]);
        ASSERT_EQ(sample.value, truth.value);
        ASSERT_EQ(sample.gradient, truth.gradient);
        ASSERT_GE(truth.value, range.lo);
        ASSERT_LE(truth.value, range.hi);
      }
      part = next;
      const double smaller = 0.4 * radius;
      center = inBall(random, center, radius - smaller);
      radius = smaller;
    }
    after += part.nodes.size();
  }
  // In the smallest balls, of 2.6 mm in 120 mm, only few operands remain.
  EXPECT_LT(after, before / 2);
}

TEST(FieldParts, BeyondTheLimitOnlyTheSignIsKept) {
  Random random(11);
  constexpr double kLimit = 3e-3;
  const auto within = [&](double value) { return std::clamp(value, -kLimit, kLimit); };
  std::size_t exact = 0, limited = 0;
  for (int round = 0; round < 600; ++round) {
    const FieldPtr field = treeOf(random, 1 + round % 3);
    const FieldParts parts(*field);
    const Vec3 center = random.in(kRegion);
    FieldPart part, all;
    static_cast<void>(parts.narrow(parts.whole(), center, 2e-3, kInfinity, all));
    static_cast<void>(parts.narrow(parts.whole(), center, 2e-3, kLimit, part));
    exact += all.nodes.size();
    limited += part.nodes.size();
    const PointBatch points = batchIn(random, center, 2e-3);
    ValueBatch values{};
    parts.values(part, points, values);
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      ASSERT_EQ(within(values[n]), within(field->value(points[n]))) << round;
    }
  }
  EXPECT_LT(limited, exact);
}

// Of many operands a cell keeps few; but where nothing is known about an operand, it is kept.
TEST(FieldParts, KeepWhatNothingIsKnownOf) {
  UserFunction function;
  function.value = [](const Vec3& p) { return p.x - 1e-3; };
  function.bounds = Box3::everything();
  function.feature_size = 1e-3;
  function.lipschitz_domain = Box3{Vec3(-1e-3), Vec3(1e-3)};
  std::vector<FieldPtr> operands{userField(function)};
  for (int n = 0; n < 1000; ++n) operands.push_back(sphere(Vec3(0.0, 0.0, 10e-3 * n), 2e-3));
  const FieldPtr field = unite(operands);
  const FieldParts parts(*field);
  ASSERT_EQ(parts.whole().nodes.size(), 1002U);
  FieldPart part;
  const ValueRange range = parts.narrow(parts.whole(), Vec3(6e-3, 0.0, 1.0), 1e-3, 0.01, part);
  EXPECT_EQ(range.lo, -kInfinity);
  ASSERT_EQ(part.nodes.size(), 3U);  // the union, the operand without bounds, and the ball at 1 m
  EXPECT_EQ(part.nodes.front().size, 3U);
  static_cast<void>(parts.narrow(parts.whole(), Vec3(0.0), 1e-4, 0.01, part));
  EXPECT_EQ(part.nodes.size(), 1U);
}

}  // namespace
}  // namespace palpate::vdb
