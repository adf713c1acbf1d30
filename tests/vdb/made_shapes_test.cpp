// Synthetic scans that are hard for voxels: a shell of barely two voxels, and folds that touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/scan_surface.h"
#include "vdb/made_scans.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

constexpr double kMm = 1e-3;

/// A scene of one layer with a wall of `stiffness` [N/m].
ScenePtr sceneOf(const FieldPtr& field, double stiffness) {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "body";
  layer.inside = std::make_shared<FieldSource>(field);
  layer.wall.material = "wall";
  description.layers.push_back(std::move(layer));
  Material wall;
  wall.name = "wall";
  wall.stiffness = stiffness;
  description.materials.push_back(std::move(wall));
  return compile(description);
}

/// The last tick of a hand that moves from one point to another [mm], 0.05 mm per tick.
TickResult pressed(const ScenePtr& scene, const Vec3& from, const Vec3& to) {
  const std::unique_ptr<HapticRenderer> renderer = makeRenderer(scene);
  const int ticks = static_cast<int>(glm::length(to - from) / 0.05);
  TickResult result;
  for (int tick = 0; tick <= ticks; ++tick) {
    const Vec3 hand = from + (to - from) * (static_cast<double>(tick) / ticks);
    result = renderer->update({hand * kMm, Vec3(0.0), 1e-3});
  }
  return result;
}

// A shell of 1.5 voxels in a grid with half the voxel size, and one of two voxels in a grid like
// the scan.
TEST(MadeShell, OfOneToTwoVoxelsHasTwoWallsAndNoHole) {
  const Vec3 center(4, -9, 21);
  constexpr double kRadius = 16.0;
  const TempFolder folder;
  for (const auto& [thickness, voxel] : {std::pair(1.5, 0.5), std::pair(2.0, 1.0)}) {
    SCOPED_TRACE(thickness);
    const double half = 0.5 * thickness;
    const Image image = readImage(test::writeNifti(
        test::imageAround(center, test::obliqueAxes(Vec3(1, 1, 1)), 40.0,
                          [&](const Vec3& mm) {
                            return std::abs(glm::length(mm - center) - kRadius) < half ? 1 : 0;
                          }),
        folder, "shell.nii.gz"));
    const LevelSet set = surfaceFromLabels(image, {.values = {1}, .voxel_size = voxel * kMm}, {});
    EXPECT_EQ(scanLoss(set.info()).lost, 0U);
    EXPECT_EQ(scanLoss(set.info()).filled, 0U);
    const FieldPtr field = gridField(set);
    std::mt19937 random(3);
    double inner = 0.0, outer = 0.0, worst = 0.0;
    constexpr int kRays = 1000;
    for (int n = 0; n < kRays; ++n) {
      const Vec3 way = test::direction(random);
      // Both walls, in steps of 0.01 mm.
      double in = 0.0, out = 0.0;
      for (double r = kRadius - 4.0; r < kRadius + 4.0; r += 0.01) {
        if (field->value((center + r * way) * kMm) >= 0.0) continue;
        if (in == 0.0) in = r;
        out = r;
      }
      ASSERT_GT(in, 0.0) << "a hole at " << way.x << " " << way.y << " " << way.z;
      inner += (in - kRadius + half) / kRays;
      outer += (out - kRadius - half) / kRays;
      worst = std::max({worst, std::abs(in - kRadius + half), std::abs(out - kRadius - half)});
    }
    std::printf("  %.1f mm: inner wall %+.2f mm off, outer %+.2f, %.2f at most\n", thickness, inner,
                outer, worst);
    // A wall passes between voxel centers, so that it is known to about half a diagonal; the volume
    // is kept.
    EXPECT_NEAR(inner, 0.0, 0.15);
    EXPECT_NEAR(outer, 0.0, 0.15);
    EXPECT_LT(worst, 1.0);
    // The inside of the shell is not part of it: a probe is held on both sides, 0.4 mm deep.
    const ScenePtr scene = sceneOf(field, 500.0);
    const Vec3 way = glm::normalize(Vec3(0.2, 0.9, -0.3));
    for (const double side : {1.0, -1.0}) {
      const double wall = kRadius + side * half;
      const TickResult held =
          pressed(scene, center + (wall + side * 3.0) * way, center + (wall - side * 0.4) * way);
      EXPECT_TRUE(held.contact);
      EXPECT_GT(side * glm::dot(held.force, way), 0.0);
      // The wall is right within a third of a voxel, like walls of labels.
      EXPECT_NEAR(glm::length(held.force), 500.0 * 0.4 * kMm, 500.0 * 0.33 * kMm);
    }
  }
}

/// How many of `rays` outwards from the middle meet no wall within 2 mm of `radius` [mm], and the
/// place of one of them [mm].
struct Holes {
  int count = 0;
  Vec3 place{0.0};
};
Holes holesOf(const Field& field, const Vec3& center, double radius, int rays,
              std::mt19937& random) {
  Holes holes;
  for (int n = 0; n < rays; ++n) {
    const Vec3 way = test::direction(random);
    double r = radius - 2.0;
    while (r < radius + 2.0 && field.value((center + r * way) * kMm) >= 0.0) r += 0.02;
    if (r < radius + 2.0) continue;
    ++holes.count;
    holes.place = center + radius * way;
  }
  return holes;
}

Image shellOf(const Vec3& center, const Mat3& axes, double radius, double thickness) {
  return test::imageAround(center, axes, 2.0 * radius + 8.0, [&](const Vec3& mm) {
    return std::abs(glm::length(mm - center) - radius) < 0.5 * thickness ? 1 : 0;
  });
}

// Where the wall is a single voxel between places of two, smoothing leaves 0.06 mm of it, and a
// grid of the scan's voxels has a hole there, in 1 of 4000 directions.
TEST(MadeShell, OfOneAndAHalfVoxelsReportsItsHoleInAGridOfTheScansVoxels) {
  const Vec3 center(4, -9, 21);
  const Image image = shellOf(center, test::obliqueAxes(Vec3(1, 1, 1)), 16.0, 1.5);
  const LevelSet set = surfaceFromLabels(image, {.values = {1}}, {});
  const FieldPtr field = gridField(set);
  std::mt19937 random(3);
  const Holes holes = holesOf(*field, center, 16.0, 20'000, random);
  ASSERT_GT(holes.count, 0);
  const ScanLoss loss = scanLoss(set.info());
  EXPECT_GT(loss.lost, 0U);
  EXPECT_LT(loss.lost, 20U) << "the wall is whole elsewhere";
  EXPECT_NE(scanLossNote(set.info()).find("thinner than voxels of 1 mm"), std::string::npos);
}

TEST(MadeShell, OfOneAndAHalfVoxelsAndMoreReportsEveryHole) {
  const int shells = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 400 : 10;
  int with_holes = 0;
  for (int seed = 1; seed <= shells; ++seed) {
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    const auto in = [&](double from, double to) {
      return std::uniform_real_distribution<double>(from, to)(random);
    };
    const Vec3 center(in(-10, 10), in(-10, 10), in(-10, 10));
    const double radius = in(6, 14);
    // A mask's outside voxels are connected across edges: a wall thinner than the diagonal of a
    // voxel's face may be open in the scan itself.
    const double thickness = in(1.42, 2);
    const double voxel = in(0.5, 1);
    const Image image =
        shellOf(center, test::obliqueAxes(Vec3(1, 1, 1), in(0, 1.5)), radius, thickness);
    const LevelSet set = surfaceFromLabels(image, {.values = {1}, .voxel_size = voxel * kMm}, {});
    const Holes holes = holesOf(*gridField(set), center, radius, 3000, random);
    if (holes.count == 0) continue;
    ++with_holes;
    EXPECT_GT(scanLoss(set.info()).lost, 0U)
        << "seed " << seed << ": " << thickness << " mm thick in voxels of " << voxel
        << " mm, a hole at " << holes.place.x << " " << holes.place.y << " " << holes.place.z;
  }
  std::printf("  %d of %d shells have holes, all reported\n", with_holes, shells);
}

/// A sheet 3 mm thick around z = 8 sin(2 pi x / 9), unbounded along y: gyri and sulci whose banks
/// nearly touch at the bottom. [mm]
struct Cortex {
  static constexpr double kHeight = 8.0;
  static constexpr double kLength = 9.0;
  static constexpr double kThickness = 3.0;

  /// Negative inside the sheet.
  [[nodiscard]] static double distance(const Vec3& p) {
    double nearest = 1e9;
    constexpr double kStep = 0.02;
    for (double x = p.x - 0.5 * kLength; x < p.x + 0.5 * kLength; x += kStep) {
      const double z = kHeight * std::sin(2.0 * std::numbers::pi * x / kLength);
      nearest = std::min(nearest, std::hypot(x - p.x, z - p.z));
    }
    return nearest - 0.5 * kThickness;
  }
};

TEST(MadeCortex, FoldsThatTouchKeepTheirSulciAsFarAsVoxelsTellThem) {
  // Voxels aligned with the axes: the values along a row in y are the same, and are computed once.
  Image image;
  image.source = "cortex.nii";
  image.size = {44, 9, 27};
  image.axes = Mat3(kMm);
  image.origin = Vec3(-22.0, -4.0, -13.0) * kMm;
  for (int k = 0; k < image.size[2]; ++k) {
    std::vector<float> row;
    for (int i = 0; i < image.size[0]; ++i) {
      const Vec3 p = image.toWorld(Vec3(i, 0, k)) / kMm;
      row.push_back(std::abs(p.x) < 19.0 && Cortex::distance(p) < 0.0 ? 1.0F : 0.0F);
    }
    for (int j = 0; j < image.size[1]; ++j) {
      image.values.insert(image.values.end(), row.begin(), row.end());
    }
  }
  const TempFolder folder;
  const Image read = readImage(test::writeNifti(image, folder, "cortex.nii.gz"));
  ASSERT_EQ(read.values, image.values);
  const LevelSet set = surfaceFromLabels(read, {.values = {1}}, {});
  EXPECT_EQ(scanLoss(set.info()).lost + scanLoss(set.info()).filled, 0U);
  const FieldPtr field = gridField(set);

  // A place nearer to the wall than half a voxel's diagonal may be on either side; all others are
  // on their own side.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> x(-16, 16), y(-2, 2), z(-12, 12);
  std::size_t known = 0, wrong = 0, sulci = 0;
  double off = 0.0;
  for (int n = 0; n < 10'000; ++n) {
    const Vec3 p(x(random), y(random), z(random));
    const double truth = Cortex::distance(p);
    const double ours = field->value(p * kMm) / kMm;
    if (std::abs(truth) < std::sqrt(3.0) / 2.0) {
      off = std::max(off, std::abs(truth) > 0.5 && truth * ours < 0.0 ? std::abs(truth) : 0.0);
      continue;
    }
    ++known;
    sulci += truth > 0.0 && std::abs(p.z) < Cortex::kHeight ? 1U : 0U;
    wrong += truth * ours < 0.0 ? 1U : 0U;
  }
  std::printf(
      "  %zu places, %zu of them in sulci, %zu on the wrong side; nearer ones by up to %.2f mm\n",
      known, sulci, wrong, off);
  EXPECT_GT(sulci, 300U);
  EXPECT_EQ(wrong, 0U);

  // Down into a sulcus, and from there 2.5 mm into one of its banks: the probe stays in this
  // sulcus, although the next one is hardly farther. The bank is steep at this height; the force is
  // K times the depth, within half a voxel and the effect of the slope.
  const ScenePtr scene = sceneOf(field, 400.0);
  const double valley = -0.25 * Cortex::kLength;  // where the sheet is lowest
  const Vec3 mouth(valley, 0, 12), middle(valley, 0, 3);
  ASSERT_GT(Cortex::distance(middle), 0.4);
  const std::unique_ptr<HapticRenderer> renderer = makeRenderer(scene);
  TickResult result;
  for (int tick = 0; tick <= 400; ++tick) {
    const double down = std::min(tick / 200.0, 1.0), aside = std::max(tick / 200.0 - 1.0, 0.0);
    const Vec3 hand = mouth + down * (middle - mouth) + aside * Vec3(2.5, 0, 0);
    result = renderer->update({hand * kMm, Vec3(0.0), 1e-3});
  }
  const Vec3 hand = middle + Vec3(2.5, 0, 0);
  const Vec3 proxy = result.proxy / kMm;
  const double depth = glm::length(hand - proxy);
  std::printf("  held at (%.2f, %.2f), %.2f mm deep; the sheet is %.2f mm away\n", proxy.x, proxy.z,
              depth, Cortex::distance(proxy));
  EXPECT_TRUE(result.contact);
  EXPECT_LT(proxy.x, hand.x);
  EXPECT_GT(proxy.x, valley - 1.0);
  EXPECT_LT(std::abs(Cortex::distance(proxy)), 0.5);
  EXPECT_NEAR(glm::length(result.force), 400.0 * depth * kMm, 1e-6);
  EXPECT_LT(result.force.x, 0.0);
}

}  // namespace
}  // namespace palpate::vdb
