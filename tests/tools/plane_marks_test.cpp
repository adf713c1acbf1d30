// Lines of equal distance and forces at rest on a cut plane, compared with closed forms.

#include <cmath>

#include "picture/distance_lines.h"
#include "picture/rest_forces.h"
#include "tools/space_look.h"

namespace palpate::testing {
namespace {

constexpr const char* kBall =
    "palpate: 1\nlength: mm\nmaterials:\n  rubber: {stiffness: 400 N/m}\nlayers:\n"
    "  - {name: ball, wall: rubber, inside: {sphere: {center: [3, 0, -2], radius: 30}}}\n"
    "  - {name: core, wall: rubber, inside: {sphere: {center: [3, 0, -2], radius: 12}}}\n";
const Vec3 kCenter(0.003, 0.0, -0.002);

TEST(DistanceLines, RingsAroundABall) {
  const ScenePtr scene = compile(parseScene(kBall, "test"));
  const tools::DistanceLines lines(*scene, 0.002);
  const double pixel = 1e-4;
  const Vec3 across(0.0, 1.0, 0.0);
  const auto ink = [&](double radius) {
    return lines.inkAt(kCenter + Vec3(radius * 0.6, 0.0, radius * 0.8), across, pixel);
  };
  EXPECT_EQ(ink(0.030), 0.0) << "the surface itself has none";
  for (int k = 1; k <= 4; ++k) {
    EXPECT_GT(ink(0.030 + 0.002 * k), 0.3) << k;
    EXPECT_GT(ink(0.030 - 0.002 * k), 0.3) << k;
    EXPECT_EQ(ink(0.031 + 0.002 * k), 0.0) << k;
    EXPECT_GT(ink(0.012 - 0.002 * k), 0.3) << "of the core, which is nearer";
  }
  EXPECT_GT(ink(0.040), 1.5 * ink(0.038)) << "every fifth is dark";
  // Two pixels away there is no line, whatever the angle between the plane and the surface.
  for (const double y : {0.0, 0.010, 0.020}) {
    const double on = std::sqrt(0.036 * 0.036 - y * y);
    EXPECT_GT(lines.inkAt(kCenter + Vec3(on, y, 0), across, pixel), 0.3) << y;
    EXPECT_EQ(lines.inkAt(kCenter + Vec3(on + 2 * pixel, y, 0), across, pixel), 0.0) << y;
  }
}

TEST(RestForces, ABallPushesOutAsItsWallSays) {
  const ScenePtr scene = compile(parseScene(kBall, "test"));
  const tools::CutPlane plane = tools::planeAcross(1, 0.010, {"mm", 1e-3});
  const Box3 box = scene->bounds().grownBy(0.005);
  constexpr int kCount = 14;
  const auto found = tools::restForces(*scene, plane, box, kCount, {});
  const double spacing = tools::restSpacing(plane, box, kCount);
  EXPECT_NEAR(spacing, 0.070 / kCount, 1e-12);
  int inside = 0;
  for (int i = 0; i < kCount; ++i) {
    for (int j = 0; j < kCount; ++j) {
      const Vec3 d((i + 0.5 - 0.5 * kCount) * spacing, 0.010, (j + 0.5 - 0.5 * kCount) * spacing);
      if (glm::length(d) < 0.030) ++inside;
    }
  }
  EXPECT_EQ(static_cast<int>(found.size()), inside) << "and none outside";
  for (const tools::RestForce& f : found) {
    const Vec3 d = f.at - kCenter;
    EXPECT_NEAR(f.at.y, 0.010, 1e-12);
    const Vec3 want = 400.0 * (0.030 - glm::length(d)) * glm::normalize(d);
    // 12 N at most: the error of the contact solver, 1e-5 of that, would not move a pixel.
    EXPECT_LT(glm::length(f.force - want), 1e-4) << d.x << " " << d.z;
  }
}

TEST(RestForces, BesideTheSceneThereIsNone) {
  const ScenePtr scene = compile(parseScene(kBall, "test"));
  const Box3 box{Vec3(-0.1, 0.04, -0.1), Vec3(0.1)};
  const tools::CutPlane plane = tools::planeAcross(1, 0.05, {"mm", 1e-3});
  EXPECT_TRUE(tools::restForces(*scene, plane, box, 5, {}).empty());
}

}  // namespace
}  // namespace palpate::testing
