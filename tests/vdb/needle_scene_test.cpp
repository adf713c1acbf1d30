// A needle in the scanned head of data/scenes: its force compared with the model, using the depths
// of the brain in the grids that are felt, which in turn are compared with the image.
#include <gtest/gtest.h>

#include <cmath>

#include "folders/folders.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

TEST(NeedleScene, BrainIsCutAndHoldsTheShaft) {
  SceneRegistry registry;
  registerKinds(registry, {});
  const ScenePtr scene =
      compile(readScene(palpate::test::sourceFolder() + "/data/scenes/needle.yaml", registry));
  const Vec3 from = Vec3(-100, -42, 60) * kMm;
  const Vec3 to = Vec3(-12, -18, 8) * kMm;
  const Vec3 way = glm::normalize(to - from);
  const RegionId brain = scene->regionNamed("brain");
  const RegionId thalamus = scene->regionNamed("thalamus");

  // [m] along the way, by bisection on the region of a point.
  const auto entry_of = [&](RegionId region) {
    double outside = 0.0;
    while (scene->regionAt(from + (outside + kMm) * way) != region) outside += kMm;
    double inside = outside + kMm;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (outside + inside);
      (scene->regionAt(from + middle * way) == region ? inside : outside) = middle;
    }
    return inside;
  };
  const double entry = entry_of(brain);
  const double nucleus = entry_of(thalamus);
  EXPECT_GT(nucleus - entry, 0.03);

  const std::unique_ptr<HapticRenderer> renderer = makeRenderer(scene);
  const double speed = 0.02;  // [m/s]
  const double tick = 1e-3;
  const double end = glm::distance(from, to);
  int compared = 0;
  double worst = 0.0;
  double pierced = 0.0;
  double last = 0.0;
  for (int i = 0; i * speed * tick < end; ++i) {
    const double depth = i * speed * tick;
    const TickResult r = renderer->update({from + depth * way, speed * way, tick});
    for (const PortCrossing& crossing : renderer->crossings()) {
      if (crossing.to != thalamus) continue;
      pierced = depth;
      EXPECT_EQ(crossing.how, PortCrossing::How::kPuncture);
      EXPECT_GT(crossing.force, 0.15 - 1e-12);
      // The wall opens at once, while cutting and friction remain.
      EXPECT_LT(glm::length(r.force), last);
      EXPECT_GT(glm::dot(r.force, -way), 0.07);
    }
    last = glm::length(r.force);
    // The first part is pressed before it is cut (0.05 N / 90 N/m), and the shaft slides from 0.15
    // mm on.
    if (depth > entry + kMm && depth < nucleus) {
      ASSERT_EQ(r.region, brain);
      const double model = 0.05 + (depth - entry) * (1.0 + 10.0 * speed);
      worst = std::max(worst, glm::length(r.force + model * way));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  // 1.2 N/m times the accuracy of the surface, 1e-9 of a grid's size, with a margin.
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(pierced, nucleus);
  EXPECT_LT(pierced, nucleus + 0.005);

  // By the image, the brain begins where its interpolated value reaches 20: this agrees within a
  // voxel of 1.5 mm, and the force accordingly, with a slope of 1.2 N/m.
  const Image image = readNifti("/usr/share/mricron/templates/ch2bet.nii.gz");
  double by_image = 0.0;
  while (by_image < end && !(image.interpolate(from + by_image * way) > 20.0)) {
    by_image += 0.05 * kMm;
  }
  EXPECT_NEAR(by_image, entry, 1.5 * kMm);
}

}  // namespace
}  // namespace palpate::vdb
