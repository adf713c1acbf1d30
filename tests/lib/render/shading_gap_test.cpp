// The set-up of a scene reports shading over a larger radius than its surface is known; the hand
// still feels it.

#include "palpate/render/shading_gap.h"

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// A ball that is known only as a grid knows it: within `band` of its surface.
class BandedBall final : public Field {
 public:
  BandedBall(double radius, double band) : ball_(sphere(Vec3(0.0), radius)), band_(band) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample s = ball_->sample(p);
    if (std::fabs(s.value) <= band_) return s;
    return {std::copysign(band_, s.value), Vec3(0.0), false};
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldSample s = sample(p);
    if (s.in_band) return ball_->jet(p);
    return {s.value, Vec3(0.0), Mat3(0.0), false};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return ball_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return ball_->featureSize(); }

 private:
  FieldPtr ball_;
  double band_;
};

SceneDescription bandedDescription(double band, double shading) {
  SceneDescription description;
  Material wall;
  wall.name = "wall";
  wall.stiffness = 1000.0;
  wall.shading = shading;
  description.materials = {wall};
  LayerDescription layer;
  layer.name = "ball";
  layer.inside = std::make_shared<FieldSource>(std::make_shared<BandedBall>(0.02, band));
  layer.wall.material = "wall";
  description.layers = {layer};
  description.meters_per_unit = 1e-3;
  return description;
}

ScenePtr bandedScene(double band, double shading) {
  return compile(bandedDescription(band, shading));
}

TEST(ShadingGaps, AreToldWhereTheBandIsTooNarrow) {
  EXPECT_TRUE(shadingGaps(*bandedScene(2e-3, 0.0)).empty());
  EXPECT_TRUE(shadingGaps(*bandedScene(2e-3, 1e-3)).empty());
  const std::vector<ShadingGap> gaps = shadingGaps(*bandedScene(2e-3, 3e-3));
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].region, 1);
  EXPECT_EQ(gaps[0].material, 0);
  EXPECT_NEAR(gaps[0].needed, 4.5e-3, 1e-12);
  EXPECT_NEAR(gaps[0].known, 2e-3, 4.5e-3 / 16 / 256);
  EXPECT_NEAR(glm::length(gaps[0].at), 0.02, 1e-9);
}

TEST(ShadingGaps, NameTheMaterialAmongOthersThatAreNotShaded) {
  SceneDescription description = bandedDescription(2e-3, 3e-3);
  Material plain;
  plain.name = "plain";
  plain.stiffness = 500.0;
  description.materials.insert(description.materials.begin(), plain);
  const std::vector<ShadingGap> gaps = shadingGaps(*compile(description));
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].material, 1);
}

TEST(ShadingGaps, ShadingIsFeltAllTheSame) {
  // Smoothing makes a ball smaller: with a band that is too narrow the effect is slightly smaller
  // or larger, but it never vanishes.
  for (const double band : {2e-3, 20e-3}) {
    Drive hand(bandedScene(band, 3e-3));
    (void)hand.to(mm(0, 0, 22));
    (void)hand.walk(mm(0, 0, 19));
    EXPECT_LT(hand.last().force.z, 0.98) << band;
    EXPECT_GT(hand.last().force.z, 0.8) << band;
  }
}

}  // namespace
}  // namespace palpate::test
