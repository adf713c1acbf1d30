// Fields of up to 10 000 parts: those that evaluate only a few of their parts must give the same as
// evaluating all.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "palpate/core/bounds_tree.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/alloc_guard.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Box3 kRoom{Vec3(-0.2), Vec3(0.2)};

/// Shapes with different metrics: exact ones, some placed or combined, and now and then one of
/// which only the sign is known.
FieldPtr anyShape(Random& random, std::size_t number, double size) {
  const Vec3 c = random.in(kRoom);
  const double r = size * random.uniform(0.5, 1.5);
  switch (number % 8) {
    case 0:
      return box(c, Vec3(r, 2.0 * r, 0.7 * r));
    case 1:
      return cylinder(c, random.direction(), 0.5 * r, 2.0 * r);
    case 2:
      return place(ellipsoid(Vec3(0.0), Vec3(r, 0.5 * r, 0.7 * r)),
                   {rotationAbout(random.direction(), random.uniform(0.0, 3.0)), c});
    case 3:
      return unite({sphere(c, r), sphere(c + 0.5 * r * random.direction(), r)});
    case 4:
      return intersect({sphere(c, r), box(c, Vec3(1.5 * r))});
    case 5:
      return number % 64 == 5 ? heart(c, r) : torus(c, random.direction(), r, 0.3 * r);
    default:
      return sphere(c, r);
  }
}

std::vector<FieldPtr> shapes(std::size_t count) {
  Random random(count);
  std::vector<FieldPtr> out;
  const double size = 0.15 / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) out.push_back(anyShape(random, i, size));
  return out;
}

/// Index of the operand that decides, the first of several equal ones, found by evaluating all.
std::size_t decider(const std::vector<FieldPtr>& operands, bool is_minimum, const Vec3& p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < operands.size(); ++i) {
    const double next = operands[i]->value(p);
    const double least = operands[best]->value(p);
    if (is_minimum ? next < least : next > least) best = i;
  }
  return best;
}

/// Points anywhere, on surfaces, far away, and where several operands may be equal.
std::vector<Vec3> probes(const std::vector<FieldPtr>& operands, std::size_t count) {
  Random random(7);
  std::vector<Vec3> out = {Vec3(0.0), Vec3(1e6, -1e6, 3.0), Vec3(1e120, 0.0, 0.0)};
  while (out.size() < count) {
    Vec3 p = random.in(kRoom);
    out.push_back(p);
    const auto which =
        static_cast<std::size_t>(random.uniform(0.0, 0.999) * static_cast<double>(operands.size()));
    const Box3 bounds = operands[which]->bounds();
    if (!bounds.isBounded()) continue;
    out.push_back(bounds.center());
    p = random.in(bounds);
    for (int i = 0; i < 4; ++i) {
      const FieldSample s = operands[which]->sample(p);
      p -= s.value / std::max(glm::dot(s.gradient, s.gradient), 1e-6) * s.gradient;
    }
    out.push_back(p);
  }
  return out;
}

void expectAsIfAllWereAsked(const Field& field, const std::vector<FieldPtr>& operands,
                            bool is_minimum, std::size_t points) {
  for (const Vec3& p : probes(operands, points)) {
    const FieldSample expected = operands[decider(operands, is_minimum, p)]->sample(p);
    const FieldSample got = field.sample(p);
    ASSERT_EQ(got.value, expected.value) << p.x << " " << p.y << " " << p.z;
    ASSERT_EQ(got.gradient, expected.gradient) << p.x << " " << p.y << " " << p.z;
    ASSERT_EQ(field.value(p), expected.value);
    const FieldJet jet = field.jet(p);
    ASSERT_EQ(jet.value, expected.value);
    ASSERT_EQ(jet.gradient, expected.gradient);
  }
}

class BigTrees : public ::testing::TestWithParam<std::size_t> {};

std::size_t pointsFor(std::size_t operands) { return operands > 1000 ? 150 : 1500; }

TEST_P(BigTrees, UnionIsBitEqualToAskingAll) {
  const std::vector<FieldPtr> operands = shapes(GetParam());
  expectAsIfAllWereAsked(*unite(operands), operands, true, pointsFor(operands.size()));
}

TEST_P(BigTrees, DifferenceIsBitEqualToAskingAll) {
  std::vector<FieldPtr> operands = shapes(GetParam());
  operands.insert(operands.begin(), box(Vec3(0.0), Vec3(0.39)));
  const FieldPtr field = subtract(operands);
  for (std::size_t i = 1; i < operands.size(); ++i) operands[i] = complement(operands[i]);
  expectAsIfAllWereAsked(*field, operands, false, pointsFor(operands.size()));
}

TEST_P(BigTrees, UnionOfUnionsAndWithAHalfSpaceIsBitEqualToAskingAll) {
  const std::vector<FieldPtr> all = shapes(GetParam());
  std::vector<FieldPtr> groups;
  for (std::size_t i = 0; i < all.size(); i += 10) {
    groups.push_back(
        unite({all.begin() + static_cast<std::ptrdiff_t>(i),
               all.begin() + static_cast<std::ptrdiff_t>(std::min(i + 10, all.size()))}));
  }
  groups.push_back(halfSpace(Vec3(0.0, 0.0, -0.15), Vec3(0.0, 0.1, 1.0)));
  expectAsIfAllWereAsked(*unite(groups), groups, true, pointsFor(all.size()));
}

TEST_P(BigTrees, EqualOperandsAreDecidedByTheFirst) {
  // Unit balls on a lattice: between two of them both values are the same.
  std::vector<FieldPtr> operands;
  for (std::size_t i = 0; i < GetParam(); ++i) {
    const std::size_t layer = i / 400;
    operands.push_back(sphere(Vec3(static_cast<double>(i % 20), static_cast<double>(i / 20 % 20),
                                   static_cast<double>(layer)),
                              0.25));
  }
  const FieldPtr field = unite(operands);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = 0.5 * glm::round(2.0 * random.in({Vec3(0.0), Vec3(19.0, 19.0, 25.0)}));
    const FieldSample expected = operands[decider(operands, true, p)]->sample(p);
    ASSERT_EQ(field->sample(p).value, expected.value);
    ASSERT_EQ(field->sample(p).gradient, expected.gradient);
  }
}

TEST_P(BigTrees, AHalfSpaceThatIsEquallyNearDoesNotHideAnEarlierOperand) {
  // Balls in a row above a plane, and points as far from a ball's lowest point as from the plane.
  std::vector<FieldPtr> operands;
  for (std::size_t i = 0; i < GetParam(); ++i) {
    operands.push_back(sphere(Vec3(static_cast<double>(i), 0.0, 0.0), 0.25));
  }
  operands.push_back(halfSpace(Vec3(0.0, 0.0, -1.0), Vec3(0.0, 0.0, 1.0)));
  const FieldPtr field = unite(operands);
  for (std::size_t i = 0; i < GetParam(); i += 1 + GetParam() / 50) {
    const Vec3 p(static_cast<double>(i), 0.0, -0.625);
    ASSERT_EQ(operands[i]->value(p), operands.back()->value(p));
    ASSERT_EQ(field->sample(p).gradient, operands[i]->sample(p).gradient) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, BigTrees, ::testing::Values(1U, 2U, 11U, 12U, 13U, 300U, 10000U),
                         ::testing::PrintToStringParamName());

/// A ball that counts its evaluations.
class CountedBall final : public Field {
 public:
  CountedBall(FieldPtr ball, std::atomic<long>& count) : ball_(std::move(ball)), count_(count) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    ++count_;
    return ball_->sample(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return ball_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return ball_->featureSize(); }

 private:
  FieldPtr ball_;
  std::atomic<long>& count_;
};

enum class Shape { kUnion, kDifference };

double asksAPoint(std::size_t count, Shape shape) {
  std::atomic<long> asked{0};
  Random random(5);
  std::vector<FieldPtr> operands;
  std::vector<Vec3> points;
  const double radius = 0.05 / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 c = random.in(kRoom);
    operands.push_back(std::make_shared<CountedBall>(sphere(c, radius), asked));
    if (i % (count / 100) == 0) points.push_back(c + 1.01 * radius * random.direction());
  }
  if (shape == Shape::kDifference) {
    operands.insert(operands.begin(), box(Vec3(0.0), Vec3(0.5)));
  }
  const FieldPtr field =
      shape == Shape::kUnion ? unite(std::move(operands)) : subtract(std::move(operands));
  asked = 0;
  for (const Vec3& p : points) (void)field->value(p);
  return static_cast<double>(asked) / static_cast<double>(points.size());
}

TEST(BigTreeWork, NearASurfaceAHundredTimesTheOperandsAreAskedHardlyMoreOften) {
  for (const Shape shape : {Shape::kUnion, Shape::kDifference}) {
    const double few = asksAPoint(100, shape);
    const double many = asksAPoint(10000, shape);
    EXPECT_LT(many, 12.0);  // a leaf of the tree holds 4; the box of a ball overlaps a few of them
    EXPECT_LT(many, 2.0 * few + 2.0);
  }
}

TEST(BigTreeWork, NothingIsAllocated) {
  const FieldPtr field = unite(shapes(500));
  const FieldPtr blobs = metaballs(
      [] {
        Random random(1);
        std::vector<Metaball> balls;
        for (int i = 0; i < 500; ++i) balls.push_back({random.in(kRoom), 0.03, 1.0});
        return balls;
      }(),
      FallOff::kWyvill, 0.5);
  Random random(2);
  const testing::AllocGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random.in(kRoom);
    for (const Field* f : {field.get(), blobs.get()}) {
      sum += f->value(p) + f->sample(p).value + f->jet(p).value;
    }
  }
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

std::vector<Metaball> manyBalls(std::size_t count, double reach) {
  Random random(count);
  std::vector<Metaball> balls;
  const double size = reach / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    balls.push_back({random.in(kRoom), size * random.uniform(0.5, 1.5),
                     i % 5 == 4 ? -0.5 : random.uniform(0.5, 2.0)});
  }
  return balls;
}

/// iso - sum, which is the field except for its scale, by the formulas of implicit.h in the given
/// order.
double lackOf(const std::vector<Metaball>& balls, FallOff fall_off, double iso, const Vec3& p) {
  double sum = 0.0;
  for (const Metaball& ball : balls) {
    const double t = glm::dot(p - ball.center, p - ball.center) / (ball.radius * ball.radius);
    switch (fall_off) {
      case FallOff::kWyvill:
        sum += t < 1.0 ? ball.strength * std::pow(1.0 - t, 3.0) : 0.0;
        break;
      case FallOff::kGaussian:
        sum += ball.strength * std::exp(-t);
        break;
      case FallOff::kInverseSquare:
        sum += ball.strength / (1.0 + t);
        break;
    }
  }
  return iso - sum;
}

TEST(BigMetaballs, AreTheSumOfAll) {
  for (const std::size_t count : {11U, 12U, 100U, 10000U}) {
    for (const FallOff fall_off : {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare}) {
      if (count == 10000U && fall_off == FallOff::kInverseSquare)
        continue;  // every ball reaches everywhere
      const std::vector<Metaball> balls = manyBalls(count, 0.2);
      const double iso = 0.5;
      const FieldPtr field = metaballs(balls, fall_off, iso);
      // Determines the scale at a point within the bounds where iso - sum is large.
      const Vec3 at = balls.front().center;
      const double scale = field->value(at) / lackOf(balls, fall_off, iso, at);
      ASSERT_GT(scale, 0.0);
      Random random(4);
      const std::size_t points = count == 10000U ? 100 : 1000;
      for (std::size_t i = 0; i < points; ++i) {
        const Vec3 p = random.in(kRoom);
        if (!field->bounds().contains(p)) continue;
        // Sums of some tens of terms around 1 in a different order, and pow() instead of products.
        ASSERT_NEAR(field->value(p) / scale, lackOf(balls, fall_off, iso, p), 1e-12)
            << count << " balls, fall-off " << static_cast<int>(fall_off);
        ASSERT_EQ(field->value(p), field->sample(p).value);
      }
    }
  }
}

TEST(BoundsTree, VisitsNearestFirstAndNoFartherThanAsked) {
  Random random(9);
  std::vector<Box3> boxes;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 c = random.in(kRoom);
    boxes.push_back(Box3{c, c}.grownBy(0.002));
  }
  const BoundsTree tree(boxes);
  double visits = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random.in(kRoom);
    double nearest = kInfinity;
    tree.visitNearest(p, kInfinity, [&](std::uint32_t item) {
      ++visits;
      nearest = std::min(nearest, boxes[item].distanceTo(p));
      return nearest;
    });
    double expected = kInfinity;
    for (const Box3& box : boxes) expected = std::min(expected, box.distanceTo(p));
    ASSERT_EQ(nearest, expected);
    // A negative radius visits the boxes around the point, and all of them.
    int around = 0;
    tree.visitNearest(p, -1.0, [&](std::uint32_t item) {
      EXPECT_TRUE(boxes[item].contains(p));
      ++around;
      return -1.0;
    });
    EXPECT_EQ(around, std::count_if(boxes.begin(), boxes.end(),
                                    [&](const Box3& b) { return b.contains(p); }));
  }
  EXPECT_LT(visits / 100.0, 20.0);  // of 10 000
}

std::vector<FieldCase> contractCases() {
  std::vector<FieldCase> cases;
  cases.push_back({.name = "union_of_200",
                   .make = [] { return unite(shapes(200)); },
                   .region = kRoom,
                   .crease_share = 0.3});
  cases.push_back({.name = "difference_of_100",
                   .make =
                       [] {
                         auto operands = shapes(100);
                         operands.insert(operands.begin(), box(Vec3(0.0), Vec3(0.3)));
                         return subtract(std::move(operands));
                       },
                   .region = kRoom,
                   .crease_share = 0.3});
  cases.push_back({.name = "wyvill_of_200",
                   .make = [] { return metaballs(manyBalls(200, 0.25), FallOff::kWyvill, 0.5); },
                   .region = kRoom,
                   .gradient_tolerance = 1e-5});
  cases.push_back({.name = "gaussian_of_200",
                   .make = [] { return metaballs(manyBalls(200, 0.1), FallOff::kGaussian, 0.5); },
                   .region = kRoom,
                   .gradient_tolerance = 1e-5});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(BigTrees, FieldContract, ::testing::ValuesIn(contractCases()),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace palpate::test
