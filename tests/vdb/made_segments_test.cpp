// Synthetic segments that overlap: the later one in the file gets the shared voxels, and the wall
// there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include "palpate/vdb/scan_surface.h"
#include "vdb/made_scans.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

constexpr double kMm = 1e-3;

std::size_t countOf(const Image& image, float label) {
  return static_cast<std::size_t>(std::count(image.values.begin(), image.values.end(), label));
}

TEST(MadeSegments, WhereTheyOverlapTheLaterHasTheVoxelsAndTheWall) {
  const Vec3 center(0, 0, 0);
  const Mat3 axes = test::obliqueAxes(Vec3(1, 1, 1));
  const auto made = [&](const std::function<bool(const Vec3&)>& is_in) {
    return test::imageAround(center, axes, 44.0, [&](const Vec3& p) { return is_in(p) ? 1 : 0; });
  };
  // Two balls of 12 mm, 12 mm apart, and a slab through both that comes last.
  const Vec3 left(-6, 0, 0), right(6, 0, 0);
  constexpr double kRadius = 12.0;
  constexpr double kSlab = 4.0;
  const test::Segment first{"left ball",
                            made([&](const Vec3& p) { return glm::length(p - left) < kRadius; })};
  const test::Segment second{"right ball",
                             made([&](const Vec3& p) { return glm::length(p - right) < kRadius; })};
  const test::Segment third{"slab", made([&](const Vec3& p) {
                              return std::abs(p.z) < 0.5 * kSlab && std::hypot(p.x, p.y) < 16.0;
                            })};
  const TempFolder folder;
  const Image image =
      readImage(test::writeSegments({first, second, third}, folder, "made.seg.nrrd"));
  ASSERT_EQ(image.labels.names.size(), 3U);
  std::map<std::string, int> labels;
  for (const auto& [label, name] : image.labels.names) labels[name] = label;
  const auto label_of = [&](const test::Segment& segment) {
    return static_cast<float>(labels.at(segment.name));
  };
  const auto count_in = [](const std::vector<std::string>& notes) {
    return notes.back().substr(0, notes.back().find(' '));
  };
  std::size_t both = 0;
  std::size_t several = 0;
  for (std::size_t v = 0; v < image.values.size(); ++v) {
    const bool in_first = first.voxels.values[v] != 0.0F;
    const bool in_second = second.voxels.values[v] != 0.0F;
    const bool in_third = third.voxels.values[v] != 0.0F;
    both += in_first && in_second ? 1U : 0U;
    several += int{in_first} + int{in_second} + int{in_third} > 1 ? 1U : 0U;
    ASSERT_EQ(image.values[v], in_third    ? label_of(third)
                               : in_second ? label_of(second)
                               : in_first  ? label_of(first)
                                           : 0.0F);
  }
  // Voxels are 1 mm^3 each: those of the slab, of a ball, and of the lens that two balls share, as
  // the reader reports them.
  const auto voxels_of = [&](const test::Segment& segment) {
    return static_cast<double>(countOf(image, label_of(segment)));
  };
  const double slab = std::numbers::pi * 256.0 * kSlab;
  EXPECT_NEAR(voxels_of(third) / slab, 1.0, 0.02);
  const double cap = kRadius - 0.5 * glm::length(right - left);  // height of each half of the lens
  const double lens = 2.0 * std::numbers::pi * cap * cap * (3.0 * kRadius - cap) / 3.0;
  const double ball = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
  const Image pair = readImage(test::writeSegments({first, second}, folder, "pair.seg.nrrd"));
  EXPECT_EQ(count_in(pair.notes), std::to_string(both));
  EXPECT_EQ(count_in(image.notes), std::to_string(several));
  EXPECT_NEAR(static_cast<double>(both) / lens, 1.0, 0.02);
  EXPECT_NEAR(static_cast<double>(countOf(first.voxels, 1.0F)) / ball, 1.0, 0.02);

  // Walls: the right ball's wall is its sphere, also inside the left ball; the slab's is flat in
  // both.
  LabelSurfaces surfaces(
      image, {{labels.at("left ball")}, {labels.at("right ball")}, {labels.at("slab")}});
  const FieldPtr fields[] = {gridField(surfaces.surface(0, 0.0, {})),
                             gridField(surfaces.surface(1, 0.0, {})),
                             gridField(surfaces.surface(2, 0.0, {}))};
  std::mt19937 random(6);
  double sphere = 0.0, flat = 0.0;
  int spheres = 0, flats = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 p = right + kRadius * test::direction(random);
    // Away from the slab and from places where three parts meet.
    if (std::abs(p.z) > 0.5 * kSlab + 2.0 && glm::length(p - left) < kRadius - 2.0) {
      sphere = std::max(sphere, std::abs(fields[1]->value(p * kMm)) / kMm);
      sphere = std::max(sphere, std::abs(fields[0]->value(p * kMm)) / kMm);
      ++spheres;
    }
    const Vec3 q(10.0 * test::direction(random).x, 10.0 * test::direction(random).y, 0.5 * kSlab);
    if (std::hypot(q.x, q.y) < 13.0) {
      flat = std::max(flat, std::abs(fields[2]->value(q * kMm)) / kMm);
      ++flats;
    }
  }
  std::printf("  sphere off %.2f mm at most, slab %.2f mm\n", sphere, flat);
  EXPECT_GT(spheres, 500);
  EXPECT_GT(flats, 500);
  // A wall passes between centers of voxels of 1 mm.
  EXPECT_LT(sphere, 0.5);
  EXPECT_LT(flat, 0.5);
}

}  // namespace
}  // namespace palpate::vdb
