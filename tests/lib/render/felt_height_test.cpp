// Textures and shading: heights added to a wall, which also cause a force along the wall.

#include "palpate/contact/felt_height.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/energy_loop.h"
#include "palpate/contact/wall_law.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

TEST(WallLaw, ForceAndRisesAreTheSlopesOfTheEnergy) {
  const WallSpring springs[] = {{800.0, 0.0, 1.0, 1.0},
                                {400.0, 2e5, 1.0, 1.0},
                                {800.0, 0.0, 1.5, 1e-3},
                                {300.0, 1e5, 2.0, 2e-3}};
  for (const WallSpring& spring : springs) {
    for (const double height : {0.0, 0.15e-3, -0.2e-3}) {
      const WallLaw law{spring, height, 0.5, 0.6e-3};
      // Depths in and beyond each of the pieces: limited by the depth, in full, fading, faded.
      for (const double d : {0.1e-3, 0.33e-3, 0.5e-3, 0.7e-3, 1.1e-3, 1.5e-3}) {
        const double by = 1e-8;
        const double force = (law.energy(d + by) - law.energy(d - by)) / (2.0 * by);
        EXPECT_NEAR(law.force(d), force, 1e-6 * force) << d << " " << height;
        const double tangent = (law.force(d + by) - law.force(d - by)) / (2.0 * by);
        EXPECT_NEAR(law.tangent(d), tangent, 1e-5 * std::fabs(tangent)) << d << " " << height;
        WallLaw up = law;
        WallLaw down = law;
        up.height += by;
        down.height -= by;
        const double per_height = (up.energy(d) - down.energy(d)) / (2.0 * by);
        // The derivative has a corner only where the height is 0.
        EXPECT_NEAR(law.energyPerHeight(d), per_height, 1e-4 * law.force(d) + 1e-9) << d << height;
        up = down = law;
        up.spring.stiffness += 1.0;
        down.spring.stiffness -= 1.0;
        EXPECT_NEAR(law.energyPerStiffness(d), 0.5 * (up.energy(d) - down.energy(d)),
                    1e-9 * law.energyPerStiffness(d) + 1e-20);
        up = down = law;
        up.spring.stiffening += 10.0;
        down.spring.stiffening -= 10.0;
        EXPECT_NEAR(law.energyPerStiffening(d), 0.05 * (up.energy(d) - down.energy(d)),
                    1e-6 * law.energyPerStiffening(d) + 1e-20);
      }
    }
  }
}

TEST(WallLaw, BehindTheStopItIsItselfInSeries) {
  const WallLaw laws[] = {{{800.0, 0.0, 1.0, 1.0}},
                          {{400.0, 2e5, 1.0, 1.0}},
                          {{800.0, 0.0, 1.5, 1e-3}},
                          {{800.0, 0.0, 1.5, 1e-3}, 0.1e-3, 0.5, 0.5e-3}};
  const double stop = 3000.0;
  for (const WallLaw& law : laws) {
    for (double d = 0.05e-3; d < 2e-3; d += 0.05e-3) {
      const double give = d - law.force(d) / stop;
      const SoftWall soft = softWall(law, stop, give);
      EXPECT_NEAR(soft.depth, d, 1e-13);
      EXPECT_NEAR(soft.force, law.force(d), 1e-10);
      const SoftWall more = softWall(law, stop, give + 1e-9);
      EXPECT_NEAR(soft.tangent, (more.force - soft.force) / 1e-9, 2e-2 * soft.tangent) << d;
    }
  }
}

TEST(SmoothedField, GradientIsThatOfTheValueAndHasNoStep) {
  const FieldPtr box = palpate::box(Vec3(0.0), Vec3(0.02));
  SmoothedField smoothed;
  const double radius = 1e-3;
  Vec3 last(0.0);
  double steepest = 0.0;
  // The path leads over an edge, a corner and a face.
  for (int i = 0; i <= 4000; ++i) {
    const Vec3 p = Vec3(0.0101, 0.008, 0.0065) + (i / 4000.0) * Vec3(-0.0015, 0.003, 0.0045);
    const FeltHeight here = smoothed.at(*box, radius, p);
    if (i % 50 == 0) {
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 by(0.0);
        by[axis] = 1e-8;
        const double slope =
            (smoothed.at(*box, radius, p + by).value - smoothed.at(*box, radius, p - by).value) /
            2e-8;
        // Over 0.02 um the slope of a 90 degree edge changes by 2e-5 of the turn over the radius.
        ASSERT_NEAR(here.gradient[axis], slope, 2e-5) << i;
      }
    }
    if (i > 0) steepest = std::max(steepest, glm::length(here.gradient - last));
    last = here.gradient;
  }
  // This is the change over a way of 1.4 um: at an edge the gradient turns by 90 degrees over about
  // the radius.
  EXPECT_LT(steepest, 1.6 * 1.5 * 1.5e-6 / radius);
  // A plane is unchanged.
  const FieldPtr plane = halfSpace(mm(1, 2, 3), glm::normalize(Vec3(1, 2, -2)));
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = mm(1.0 + 0.1 * i, 2.0 - 0.05 * i, 3.1);
    const FeltHeight here = smoothed.at(*plane, radius, p);
    ASSERT_NEAR(here.value, plane->value(p), 1e-15);
    ASSERT_TRUE(isNear(here.gradient, plane->sample(p).gradient, 1e-11));
  }
}

std::string solid(const std::string& material, const std::string& field) {
  return R"(
palpate: 1
length: mm
materials: {m: {)" +
         material + R"(}}
layers: [{name: body, inside: )" +
         field + R"(, wall: m}]
)";
}

void expectNothingGiven(const char* what, const ScenePtr& scene, const Vec3& start,
                        const EnergyLoop& loop, double most = 1e-9) {
  const EnergyGiven given = energyGiven(scene, start, loop);
  std::printf("  %-34s %10.3g J (last halving %.2g J)\n", what, given.work, given.change);
  // Where the proxy comes to a crease, properties that vary along the walls have a corner: there
  // the sum converges only linearly with the step.
  EXPECT_LE(given.work, most + given.change) << what;
}

/// A plane whose values are not distances, as in implicit fields.
class SteepPlane final : public Field {
 public:
  SteepPlane(const Vec3& normal, double slope) : normal_(normal), slope_(slope) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return {value(p), slope_ * normal_, true};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return slope_ * glm::dot(normal_, p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return slope_; }
  [[nodiscard]] double featureSize() const noexcept override { return 0.01; }

 private:
  Vec3 normal_;
  double slope_;
};

TEST(SmoothedField, OfAnImplicitPlaneIsItsDistanceHoweverSteepItsValuesAre) {
  const Vec3 normal = glm::normalize(Vec3(1.0, -2.0, 0.5));
  for (const double slope : {0.2, 1.0, 30.0}) {
    const SteepPlane plane(normal, slope);
    SmoothedField smoothed;
    for (const double height : {-0.4e-3, 0.0, 0.3e-3}) {
      const Vec3 p = height * normal + 0.013 * glm::normalize(Vec3(2.0, 1.0, 0.0));
      // The B-spline reproduces linear data, so only rounding is left.
      const FeltHeight felt = smoothed.at(plane, 1e-3, p);
      EXPECT_NEAR(felt.value, height, 1e-15) << slope;
      EXPECT_TRUE(isNear(felt.gradient, normal, 1e-12)) << slope;
    }
  }
}

TEST(TexturedWalls, GiveNoEnergy) {
  const std::string rough = "stiffness: 1000 N/m, texture: {amplitude: 0.2 mm, wavelength: 3}";
  const std::string curved = rough + ", curve: {exponent: 1.5, reference: 1 mm}";
  Random random(3);
  for (int i = 0; i < 3; ++i) {
    EnergyLoop loop = randomLoop(random, mm(0.3, 0.4, -1.0), 0.1e-3, 1.1e-3);
    expectNothingGiven("bumps on a floor",
                       sceneOf(solid(rough, "{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}")),
                       mm(0, 0, 10), loop);
    expectNothingGiven(
        "bumps on a floor, Hertz",
        sceneOf(solid(curved, "{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}")), mm(0, 0, 10),
        loop);
    loop.center = mm(0, 0, 9);
    expectNothingGiven("bumps on a ball",
                       sceneOf(solid(rough, "{sphere: {center: [0, 0, 0], radius: 10}}")),
                       mm(0, 0, 30), loop);
  }
}

TEST(TexturedWalls, PushAlongTheWallAsTheBumpsSlope) {
  // 2 mm deep, at x = 0 of sin(2 pi x / 4 mm): the slope of the bump is A k / 3, and it counts over
  // 2 mm of depth.
  Drive hand(sceneOf(solid("stiffness: 1000 N/m, texture: {amplitude: 0.1 mm, wavelength: 4}",
                           "{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}")));
  (void)hand.to(mm(0, 1, 1));
  (void)hand.walk(mm(0, 1, -2));
  const double k = 2.0 * std::numbers::pi / 4e-3;
  const double height = 0.1e-3 / 3.0;  // the sine of y is 1
  const double along = -1000.0 * (2e-3 - 2.0 * height) * 0.1e-3 * k / 3.0;
  EXPECT_NEAR(hand.last().force.x, along, 1e-6);
  EXPECT_NEAR(hand.last().force.y, 0.0, 1e-6);
  EXPECT_NEAR(hand.last().force.z, 2.0 + 1000.0 * height, 1e-6);
}

TEST(TexturedWalls, AreNoStifferAlongTheWallThanAcross) {
  Drive hand(sceneOf(solid("stiffness: 1000 N/m, texture: {amplitude: 0.3 mm, wavelength: 2}",
                           "{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}")));
  (void)hand.to(mm(0, 0, 1));
  double most = 0.0;
  for (const double depth : {0.2, 1.0, 5.0, 20.0}) {
    (void)hand.walk(mm(0, 0.3, -depth));
    Vec3 last = hand.last().force;
    for (int i = 1; i <= 4000; ++i) {
      const Vec3 force = hand.to(mm(1e-3 * i, 0.3, -depth)).force;
      most = std::max(most, std::fabs(force.x - last.x) / 1e-6);
      last = force;
    }
  }
  std::printf("  steepest along the wall %.0f N/m\n", most);
  EXPECT_LE(most, 1000.0);
}

TEST(ShadedWalls, GiveNoEnergy) {
  const std::string shaded = "stiffness: 1000 N/m, shading: 1 mm";
  const std::string box = "{box: {center: [0, 0, 0], size: [20, 20, 20]}}";
  const std::string roof =
      "{union: [{half_space: {point: [0, 0, 0], normal: [0.3, 0, 1]}}, "
      "{half_space: {point: [0, 0, 0], normal: [-0.3, 0, 1]}}]}";
  const std::string ridge =
      "{intersection: [{half_space: {point: [0, 0, 0], normal: [0.3, 0, 1]}}, "
      "{half_space: {point: [0, 0, 0], normal: [-0.3, 0, 1]}}]}";
  Random random(5);
  for (int i = 0; i < 3; ++i) {
    EnergyLoop loop = randomLoop(random, mm(0.3, 0.4, -1.0), 0.1e-3, 0.9e-3);
    expectNothingGiven("valley of 33 degrees", sceneOf(solid(shaded, roof)), mm(0, 0, 10), loop);
    expectNothingGiven("ridge of 33 degrees", sceneOf(solid(shaded, ridge)), mm(0, 0, 10), loop);
    loop.center = mm(9.0, 0, 8.6);
    expectNothingGiven("edge of a box", sceneOf(solid(shaded, box)), mm(20, 0, 20), loop);
  }
}

}  // namespace
}  // namespace palpate::test
