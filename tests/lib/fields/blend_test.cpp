#include <gtest/gtest.h>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Vec3 kLeft(-0.02, 0, 0);
const Vec3 kRight(0.02, 0.005, 0);
constexpr double kBlend = 0.01;

FieldPtr left() { return sphere(kLeft, 0.03); }
FieldPtr right() { return ellipsoid(kRight, Vec3(0.03, 0.02, 0.025)); }
FieldPtr body() { return box(Vec3(0.0), Vec3(0.06, 0.05, 0.04)); }

std::vector<FieldCase> blendCases() {
  const Box3 region{Vec3(-0.07), Vec3(0.07)};
  std::vector<FieldCase> cases;
  cases.push_back({.name = "smooth_union",
                   .make =
                       [] {
                         return smoothUnite({left(), right()}, kBlend);
                       },
                   .region = region,
                   .awkward = {kLeft, kRight}});
  cases.push_back({.name = "smooth_union_of_three",
                   .make =
                       [] {
                         return smoothUnite({left(), right(), body()}, kBlend);
                       },
                   .region = region});
  cases.push_back({.name = "smooth_intersection",
                   .make =
                       [] {
                         return smoothIntersect({left(), right(), body()}, kBlend);
                       },
                   .region = region});
  cases.push_back({.name = "smooth_difference",
                   .make =
                       [] {
                         return smoothSubtract({body(), left(), right()}, kBlend);
                       },
                   .region = region});
  cases.push_back(
      {.name = "smooth_union_of_bounds",
       .make =
           [] {
             return smoothUnite({unite({left(), right()}), sphere(Vec3(0, 0.03, 0), 0.02)}, 0.02);
           },
       .region = region});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Blends, FieldContract, ::testing::ValuesIn(blendCases()),
                         ::testing::PrintToStringParamName());

TEST(Blend, IsPlainCsgAwayFromTheCrease) {
  const FieldPtr a = left();
  const FieldPtr b = right();
  const FieldPtr smooth = smoothUnite({a, b}, kBlend);
  const FieldPtr sharp = unite({a, b});
  int apart = 0;
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in({Vec3(-0.06), Vec3(0.06)});
    const double gap = std::fabs(a->value(p) - b->value(p));
    if (gap >= kBlend) {
      ++apart;
      EXPECT_EQ(smooth->value(p), sharp->value(p));
    } else {
      EXPECT_LE(smooth->value(p), sharp->value(p));
      EXPECT_GE(smooth->value(p), sharp->value(p) - kBlend / 6.0 - 1e-17);
    }
  }
  EXPECT_GT(apart, 100);
}

TEST(Blend, GradientAndCurvatureAreContinuousAcrossTheCrease) {
  // Two half-spaces at a right angle: walk across the crease, where their values are equal.
  const FieldPtr corner = smoothIntersect(
      {halfSpace(Vec3(0.0), Vec3(1, 0, 0)), halfSpace(Vec3(0.0), Vec3(0, 1, 0))}, kBlend);
  const double step = 1e-6;
  FieldJet before = corner->jet(Vec3(-2 * kBlend, 0, 0));
  for (double x = -2 * kBlend; x < 2 * kBlend; x += step) {
    const FieldJet now = corner->jet(Vec3(x, -x, 0));
    if (x > -2 * kBlend) {
      // The second derivative is 1 / radius, the third 1 / radius^2, each times sqrt(2) for each
      // derivative.
      EXPECT_LT(glm::length(now.gradient - before.gradient), 4.0 * step / kBlend);
      EXPECT_LT(std::fabs(now.hessian[0][0] - before.hessian[0][0]),
                4.0 * step / (kBlend * kBlend));
    }
    before = now;
  }
}

TEST(Blend, DeMorganHolds) {
  const FieldPtr a = smoothIntersect({left(), body()}, kBlend);
  const FieldPtr b = complement(smoothUnite({complement(left()), complement(body())}, kBlend));
  const FieldPtr c = smoothSubtract({left(), complement(body())}, kBlend);
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.in({Vec3(-0.06), Vec3(0.06)});
    EXPECT_EQ(a->value(p), b->value(p));
    EXPECT_EQ(a->value(p), c->value(p));
  }
}

TEST(Blend, ChecksItsParameters) {
  EXPECT_THROW(static_cast<void>(smoothUnite({}, kBlend)), Error);
  EXPECT_THROW(static_cast<void>(smoothUnite({left(), nullptr}, kBlend)), Error);
  EXPECT_THROW(static_cast<void>(smoothSubtract({left(), right()}, 0.0)), Error);
  EXPECT_THROW(static_cast<void>(smoothIntersect({left(), right()}, -1.0)), Error);
  const FieldPtr only = left();
  EXPECT_EQ(smoothUnite({only}, kBlend), only);
}

// A chain of nested blends would be as deep as it is long.
TEST(SmoothUnion, TakesTensOfThousandsOfOperands) {
  std::vector<FieldPtr> balls;
  for (int i = 0; i < 30000; ++i) balls.push_back(sphere(Vec3(0.01 * i, 0, 0), 0.004));
  const FieldPtr chain = smoothUnite(std::move(balls), 0.002);
  EXPECT_NEAR(chain->value(Vec3(150.0, 0.01, 0.0)), 0.006, 1e-15);
  EXPECT_GT(chain->jet(Vec3(150.0, 0.01, 0.0)).hessian[0][0], 0.0);
}

// A ball that knows distances only up to `band`, as a grid does.
class BandedBall final : public Field {
 public:
  explicit BandedBall(double band) : band_(band) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample s = whole_->sample(p);
    if (std::fabs(s.value) <= band_) return s;
    return {std::copysign(band_, s.value), Vec3(0.0), false};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return whole_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return whole_->featureSize(); }

 private:
  FieldPtr whole_ = left();
  double band_;
};

// Outside the band a value is not a distance: a blend or offset of it would produce surfaces where
// none exist.
TEST(Bands, MustReachAsFarAsWhatIsMadeOfThem) {
  const FieldPtr grid = place(std::make_shared<BandedBall>(0.004), {Mat3(1.0), Vec3(0.1, 0, 0)});
  EXPECT_NO_THROW((void)smoothUnite({grid, body()}, 0.003));
  EXPECT_NO_THROW((void)offset(complement(grid), 0.003));
  EXPECT_NO_THROW((void)shell(grid, 0.003));
  EXPECT_NO_THROW((void)scale(grid, 3.0));
  const auto code = [](auto&& make) {
    try {
      (void)make();
    } catch (const Error& error) {
      return error.problem().code;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(code([&] { return smoothUnite({body(), grid}, 0.005); }), "field.band_too_narrow");
  EXPECT_EQ(code([&] { return offset(grid, 0.005); }), "field.band_too_narrow");
  EXPECT_EQ(code([&] { return offset(complement(grid), -0.005); }), "field.band_too_narrow");
  EXPECT_EQ(code([&] { return shell(unite({body(), grid}), 0.005); }), "field.band_too_narrow");
  EXPECT_EQ(code([&] { return offset(scale(grid, 2.0), 0.009); }), "field.band_too_narrow");
}

/// A ball whose distance is known in its bounding box below z [m]; elsewhere, as outside a narrow
/// band, only the side is known.
class BandedCap final : public Field {
 public:
  explicit BandedCap(double z) : z_(z) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample s = ball_->sample(p);
    if (p.z < z_ && ball_->bounds().contains(p)) return s;
    return {std::copysign(1e-3, s.value), Vec3(0.0), false};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return ball_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return 1e-3; }

 private:
  FieldPtr ball_ = sphere(Vec3(0.0), 0.016);
  double z_;
};

TEST(Bands, AreLookedAtUpToTheLastLayerOfTheBox) {
  // The box is sampled in 33 layers, 1 mm apart; the last one lies on its face.
  EXPECT_NO_THROW((void)offset(std::make_shared<BandedCap>(0.0161), 0.005));
  EXPECT_THROW((void)offset(std::make_shared<BandedCap>(0.0155), 0.005), Error);
}

TEST(Bands, OfABlendOnlyWhatHasAShareMustBeInItsBand) {
  constexpr double kRadius = 0.003;
  const FieldPtr grid = std::make_shared<BandedBall>(0.004);
  const FieldPtr far = sphere(kLeft + Vec3(0.2, 0, 0), 0.03);
  for (const FieldPtr& both :
       {smoothUnite({grid, far}, kRadius), smoothUnite({far, grid}, kRadius)}) {
    const auto in_band = [&](const Vec3& p) {
      EXPECT_EQ(both->sample(p).in_band, both->jet(p).in_band);
      return both->sample(p).in_band;
    };
    EXPECT_TRUE(in_band(kLeft + Vec3(0.2, 0.0305, 0))) << "the grid is far away and has no share";
    EXPECT_TRUE(in_band(kLeft + Vec3(0, 0.031, 0))) << "on the grid's surface";
    EXPECT_FALSE(in_band(kLeft + Vec3(0, 0.05, 0))) << "out of its band, and the nearest";
  }
}

}  // namespace
}  // namespace palpate::test
