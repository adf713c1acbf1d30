// The contract suite itself: it must catch a field that violates the contract, each violation by
// the check made for it.

#include "support/field_contract.h"

#include <gtest/gtest.h>

#include <utility>

#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// A ball with one violation of the contract.
struct Lie {
  double value_scale = 1.0;
  double lipschitz = 1.0;
  double bounds_margin = 0.0;  ///< [m]
  double gradient_scale = 1.0;
  double hessian_scale = 1.0;
  double value_offset = 0.0;  ///< [m] error of value() alone
  double batch_offset = 0.0;  ///< [m] error of one value of values()
  double dent = 0.0;  ///< [m] depth of a ripple of the value, whose slope is in the gradient
  Metric metric = Metric::kExact;
  bool nan_at_center = false;
};

constexpr double kRadius = 0.05;

class LyingBall final : public Field {
 public:
  explicit LyingBall(Lie lie) : lie_(lie) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample s = truth_->sample(p);
    if (lie_.nan_at_center && p == Vec3(0.0)) s.gradient = Vec3(std::nan(""));
    const double wave = 200.0;  // [1/m] a ripple along z, steepest at z = 0
    s.value = s.value * lie_.value_scale + lie_.dent * std::sin(wave * p.z);
    s.gradient = s.gradient * lie_.gradient_scale * lie_.value_scale +
                 Vec3(0, 0, lie_.dent * wave * std::cos(wave * p.z));
    return s;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return sample(p).value + lie_.value_offset;
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    Field::values(points, out);
    out[17] += lie_.batch_offset;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet j = Field::jet(p);
    j.hessian *= lie_.hessian_scale;
    return j;
  }
  [[nodiscard]] Box3 bounds() const noexcept override {
    return truth_->bounds().grownBy(lie_.bounds_margin);
  }
  [[nodiscard]] Metric metric() const noexcept override { return lie_.metric; }
  [[nodiscard]] double lipschitz() const noexcept override { return lie_.lipschitz; }
  [[nodiscard]] double featureSize() const noexcept override { return kRadius; }

 private:
  FieldPtr truth_ = sphere(Vec3(0.0), kRadius);
  Lie lie_;
};

FieldCase caseOf(const Lie& lie) {
  return {.name = "lying_ball",
          .make = [=] { return std::make_shared<LyingBall>(lie); },
          .region = {Vec3(-0.1), Vec3(0.1)},
          .inside = [](const Vec3& p) { return glm::dot(p, p) < kRadius * kRadius; },
          .far_away = false};
}

TEST(FieldContractSuite, AcceptsTheTruth) {
  const FieldCase truth = caseOf({});
  for (const auto& check : {checkGradient, checkSign, checkBounds, checkLipschitz, checkMetric,
                            checkJet, checkValue, checkValues, checkAwkward, checkConstants}) {
    EXPECT_TRUE(check(truth));
  }
}

TEST(FieldContractSuite, CatchesAFalseLipschitzBound) {
  // Metric kImplicit, so that only the bound is wrong: the field is half a percent steeper than it
  // states.
  EXPECT_FALSE(checkLipschitz(caseOf({.value_scale = 1.005, .metric = Metric::kImplicit})));
  EXPECT_TRUE(checkLipschitz(
      caseOf({.value_scale = 1.005, .lipschitz = 1.005, .metric = Metric::kImplicit})));
}

TEST(FieldContractSuite, CatchesALipschitzBoundThatFailsInFewPlaces) {
  // The slopes of ball and ripple add up to 1.02 only near the poles.
  EXPECT_FALSE(
      checkLipschitz(caseOf({.lipschitz = 1.01, .dent = 1e-4, .metric = Metric::kImplicit})));
  EXPECT_TRUE(
      checkLipschitz(caseOf({.lipschitz = 1.02, .dent = 1e-4, .metric = Metric::kImplicit})));
}

TEST(FieldContractSuite, CatchesAFalseMetric) {
  EXPECT_FALSE(checkMetric(caseOf({.value_scale = 1.001})));
  EXPECT_FALSE(checkMetric(caseOf({.value_scale = 0.999})));
  EXPECT_TRUE(checkMetric(caseOf({.value_scale = 0.999, .metric = Metric::kBound})));
  EXPECT_FALSE(checkMetric(caseOf({.value_scale = 1.001, .metric = Metric::kBound})));
}

TEST(FieldContractSuite, CatchesEveryOtherLie) {
  EXPECT_FALSE(checkGradient(caseOf({.gradient_scale = 1.0 + 1e-5})));
  EXPECT_FALSE(checkGradient(caseOf({.gradient_scale = -1.0})));
  EXPECT_FALSE(checkSign(caseOf({.dent = 1e-4})));
  EXPECT_FALSE(checkSign(caseOf({.value_scale = -1.0})));
  EXPECT_FALSE(checkBounds(caseOf({.bounds_margin = -1e-5})));
  EXPECT_TRUE(checkBounds(caseOf({.bounds_margin = 1e-2})));
  EXPECT_FALSE(checkJet(caseOf({.hessian_scale = 1.001})));
  EXPECT_FALSE(checkValue(caseOf({.value_offset = 1e-16})));
  EXPECT_FALSE(checkValues(caseOf({.batch_offset = 1e-16})));
  EXPECT_FALSE(checkAwkward(caseOf({.nan_at_center = true})));
  EXPECT_FALSE(checkAwkward(caseOf({.gradient_scale = 1.0 + 1e-8})));
  EXPECT_FALSE(checkConstants(caseOf({.lipschitz = 2.0})));
}

}  // namespace
}  // namespace palpate::test
