// A field that is restricted to a box.

#include <gtest/gtest.h>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/error_of.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Box3 kBox{Vec3(-0.06, -0.02, -0.06), Vec3(0.01, 0.03, 0.06)};

/// A ball that must not be evaluated outside the box.
class Guarded final : public Field {
 public:
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    EXPECT_TRUE(!isFinite(p) || kBox.contains(p)) << p.x << " " << p.y << " " << p.z;
    return ball_->sample(p);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    EXPECT_TRUE(!isFinite(p) || kBox.contains(p));
    return ball_->jet(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return ball_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return 0.04; }

 private:
  FieldPtr ball_ = sphere(Vec3(0.0), 0.04);
};

std::vector<FieldCase> knownCases() {
  FieldCase ball;
  ball.name = "ball";
  ball.make = [] { return knownWithin(std::make_shared<Guarded>(), kBox); };
  ball.region = {Vec3(-0.08), Vec3(0.08)};
  ball.inside = [](const Vec3& p) { return glm::length(glm::clamp(p, kBox.lo, kBox.hi)) < 0.04; };
  // The gradient jumps on the box's faces.
  ball.crease_share = 0.2;
  return {ball};
}

INSTANTIATE_TEST_SUITE_P(KnownWithin, FieldContract, testing::ValuesIn(knownCases()),
                         testing::PrintToStringParamName());

TEST(KnownWithin, IsTheFieldInTheBoxAndGoesOnBeyondIt) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.04);
  const FieldPtr known = knownWithin(ball, kBox);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random.in(kBox);
    ASSERT_EQ(known->value(p), ball->value(p));
    ASSERT_EQ(known->sample(p).gradient, ball->sample(p).gradient);
    const Vec3 far = p + Vec3(1.0, 0.0, 0.0);
    ASSERT_EQ(known->value(far), ball->value({kBox.hi.x, p.y, p.z}));
    ASSERT_EQ(known->sample(far).gradient.x, 0.0);
  }
  const Box3 bounds = known->bounds();
  EXPECT_EQ(bounds.lo, Vec3(-0.04, -kInfinity, -0.04));
  EXPECT_EQ(bounds.hi, Vec3(kInfinity, kInfinity, 0.04));
  EXPECT_EQ(&knownField(*known), ball.get());
  EXPECT_EQ(&knownField(*ball), ball.get());
}

TEST(KnownWithin, RefusesNothingAndAnEmptyBox) {
  EXPECT_EQ(errorOf([] { (void)knownWithin(nullptr, kBox); }).problem().code,
            errorOf([] { (void)complement(nullptr); }).problem().code);
  EXPECT_EQ(errorOf([] { (void)knownWithin(sphere(Vec3(0.0), 1.0), Box3{}); }).problem().code,
            "field.empty_box");
}

/// A ball whose Lipschitz bound holds only in a box.
class BoundedIn final : public Field {
 public:
  explicit BoundedIn(const Box3& domain) : domain_(domain) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return ball_->sample(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return ball_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return domain_; }
  [[nodiscard]] double featureSize() const noexcept override { return 0.04; }

 private:
  FieldPtr ball_ = sphere(Vec3(0.0), 0.04);
  Box3 domain_;
};

TEST(KnownWithin, ItsLipschitzBoundHoldsEverywhereIfItDoesInTheWholeBox) {
  const auto domain = [](const Vec3& lo, const Vec3& hi) {
    return knownWithin(std::make_shared<BoundedIn>(Box3{lo, hi}), kBox)->lipschitzDomain();
  };
  EXPECT_FALSE(domain(kBox.lo - Vec3(0.01), kBox.hi + Vec3(0.01)).isBounded());
  // One corner of the box is in that domain, the other is not.
  const Vec3 middle = kBox.center();
  const Box3 low = domain(kBox.lo - Vec3(0.01), middle);
  EXPECT_EQ(low.lo, kBox.lo);
  EXPECT_EQ(low.hi, middle);
  const Box3 high = domain(middle, kBox.hi + Vec3(0.01));
  EXPECT_EQ(high.lo, middle);
  EXPECT_EQ(high.hi, kBox.hi);
}

}  // namespace
}  // namespace palpate::test
