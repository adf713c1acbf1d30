// Labels of one image share its points: the guarantees of the shared fields, tested on planes whose
// values are not distances.

#include "scene/label_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "support/field_contract.h"

namespace palpate {
namespace {

using test::Random;

class SteepPlane final : public Field {
 public:
  SteepPlane(const Vec3& slope, double feature) : slope_(slope), feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return {value(p), slope_, true};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return glm::dot(slope_, p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return {Vec3(-1.0), Vec3(1.0)}; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return glm::length(slope_); }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  Vec3 slope_;
  double feature_;
};

TEST(LabelShare, BoundsOfSharedFieldsHoldAndAreNotWiderThanTheyMustBe) {
  const auto flat = std::make_shared<SteepPlane>(Vec3(1.0, 0.0, 0.0), 0.02);
  const auto steep = std::make_shared<SteepPlane>(Vec3(-3.0, 0.0, 0.0), 0.01);
  const SharedLabels shared = shareLabels({{flat, {1}}, {steep, {2}}});
  ASSERT_EQ(shared.fields.size(), 2U);
  // The slope of (f_0 - f_1) / 2 is (1 + 3) / 2; that of f_1 itself is 3.
  EXPECT_EQ(shared.fields[0]->lipschitz(), 2.0);
  EXPECT_EQ(shared.fields[1]->lipschitz(), 3.0);
  EXPECT_EQ(shared.fields[0]->featureSize(), 0.01);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in({Vec3(-0.5), Vec3(0.5)});
    const Vec3 q = p + 1e-3 * random.direction();
    for (const FieldPtr& field : shared.fields) {
      EXPECT_LE(std::fabs(field->value(p) - field->value(q)),
                field->lipschitz() * glm::distance(p, q) + 1e-15);
      EXPECT_EQ(field->value(p), field->sample(p).value);
    }
  }
}

}  // namespace
}  // namespace palpate
