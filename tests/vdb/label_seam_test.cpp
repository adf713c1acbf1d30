// Labels that touch leave no gap between them: each point is in exactly one of them, or in the
// surroundings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <random>
#include <set>

#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/scan_surface.h"
#include "support/scan_folder.h"
#include "vdb/debian_scans.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

int labelAt(const Image& image, const std::array<int, 3>& v) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (v[a] < 0 || v[a] >= image.size[a]) return 0;
  }
  return static_cast<int>(image.at(v[0], v[1], v[2]));
}

/// The labels of the block of voxels that begins at `first` and has `side` voxels along each axis.
std::set<int> labelsIn(const Image& image, const std::array<int, 3>& first, int side) {
  std::set<int> result;
  for (int n = 0; n < side * side * side; ++n) {
    result.insert(labelAt(
        image, {first[0] + n % side, first[1] + n / side % side, first[2] + n / (side * side)}));
  }
  return result;
}

/// Every label of an image as a layer of a scene, and, on request, as separate grids.
struct Labels {
  Labels(const Image& of, bool by_themselves) : image(of) {
    std::set<int> values;
    for (const float value : image.values) values.insert(static_cast<int>(value));
    values.erase(0);
    std::vector<std::vector<int>> layers;
    for (const int value : values) {
      region[value] = static_cast<RegionId>(layers.size() + 1);
      layers.push_back({value});
    }
    LabelSurfaces surfaces(image, layers);
    SceneDescription description;
    for (std::size_t n = 0; n < layers.size(); ++n) {
      if (by_themselves) shared.push_back(gridField(surfaces.surface(n, 0.0, {})));
      LayerDescription layer;
      layer.name = std::to_string(layers[n].front());
      layer.inside = std::make_shared<FieldSource>(
          gridField(surfaces.surface(n, 0.0, {}, {}, LabelEdge::kLapped)));
      layer.label_group = "image";
      layer.labels = layers[n];
      description.layers.push_back(std::move(layer));
    }
    if (by_themselves) united = gridField(surfaces.united(0.0, {}).value());
    scene = compile(description);
  }

  /// How many of the scene's fields contain the point.
  [[nodiscard]] int holders(const Vec3& p) const {
    const auto regions = scene->regions();
    return static_cast<int>(std::count_if(regions.begin() + 1, regions.end(), [&](const Region& r) {
      return r.field->bounds().contains(p) && r.field->value(p) < 0.0;
    }));
  }
  /// Whether the field of the surroundings is smaller than those of all labels.
  [[nodiscard]] bool isLeft(const Vec3& p) const {
    if (!united) return false;
    const double rest = -united->value(p);
    return std::none_of(shared.begin(), shared.end(),
                        [&](const FieldPtr& field) { return field->value(p) <= rest; });
  }

  const Image& image;
  std::map<int, RegionId> region;
  std::vector<FieldPtr> shared;
  FieldPtr united;
  ScenePtr scene;
};

template <typename Visit>
void forVoxels(const Image& image, const Visit& visit) {
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) visit(std::array{i, j, k});
    }
  }
}

void checkSeams(const char* name, const Image& image, bool by_themselves = true) {
  const Labels labels(image, by_themselves);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::size_t points = 0, corners = 0, walls = 0, wrong = 0, not_one = 0, left = 0, left_alone = 0;
  std::size_t centers = 0, astray = 0;
  double shift = 0.0;
  const auto check = [&](const Vec3& index, bool is_within) {
    const Vec3 p = image.toWorld(index);
    ++points;
    const RegionId region = labels.scene->regionAt(p);
    not_one += labels.holders(p) != (region == kOutside ? 0 : 1) ? 1U : 0U;
    if (!is_within) return;
    left += region == kOutside ? 1U : 0U;
    left_alone += labels.isLeft(p) ? 1U : 0U;
  };
  forVoxels(image, [&](const std::array<int, 3>& v) {
    const auto [i, j, k] = v;
    const int own = labelAt(image, v);
    const Vec3 here(i, j, k);
    const auto near = labelsIn(image, {i - 1, j - 1, k - 1}, 3);
    const bool is_within = !near.contains(0);
    // Voxels deeper than one voxel inside: where labels meet, and a sample of the others.
    if (is_within && (near.size() > 1 || (i + 3 * j + 5 * k) % 16 == 0))
      check(here + Vec3(share(random), share(random), share(random)) - 0.5, true);
    // All around places where three or more meet, the surroundings included.
    if (labelsIn(image, v, 2).size() >= 3) {
      const bool is_deep = !labelsIn(image, {i - 1, j - 1, k - 1}, 4).contains(0);
      for (int n = 0; n < 12; ++n) {
        check(here + 2.0 * Vec3(share(random), share(random), share(random)) - 0.5, is_deep);
      }
      ++corners;
    }
    if (own == 0) return;
    // Look at the walls between this voxel and its neighbors.
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<int, 3> next = v;
      ++next[a];
      const int other = labelAt(image, next);
      if (other == 0 || other == own || !is_within) continue;
      const auto beyond = labelsIn(image, {next[0] - 1, next[1] - 1, next[2] - 1}, 3);
      if (beyond.contains(0)) continue;
      Vec3 step(0.0);
      step[static_cast<int>(a)] = 1.0;
      for (int n = 0; n <= 10; ++n) check(here + 0.1 * n * step, true);
      ++walls;
    }
    // Laps hardly move walls: centers stay in their own region, with few exceptions.
    ++centers;
    const Vec3 p = image.toWorld(here);
    const FieldPtr& field = labels.scene->regions()[labels.region.at(own)].field;
    const double off = field->value(p) / field->featureSize();
    astray += off > 0.2 ? 1U : 0U;
    shift = std::max(shift, off);
    wrong += labels.scene->regionAt(p) != labels.region.at(own) ? 1U : 0U;
  });
  std::printf(
      "%-9s %zu points, %zu corners, %zu walls: in not exactly one %zu, left in the scene %zu, by "
      "the "
      "smallest field %zu\n          centers %zu, not in their own %zu, by more than 0.2 voxel "
      "%zu, "
      "%.2f at most\n",
      name, points, corners, walls, not_one, left, left_alone, centers, wrong, astray, shift);
  EXPECT_GT(corners, 100U);
  EXPECT_GT(walls, 100U);
  EXPECT_EQ(not_one, 0U);
  EXPECT_EQ(left, 0U);
  EXPECT_EQ(left_alone, 0U);
  // Laps blur walls near edges of thin parts: 43 of the vertebra's 36348 centers, 2 of the
  // abdomen's 345988. Grids without laps have 0 and 4.
  EXPECT_LT(static_cast<double>(astray), 1.5e-3 * static_cast<double>(centers));
}

/// A ball of two halves, and a third label that caps one side: three parts meet in a line inside
/// it, and along lines on its surface. `axes` in mm.
Image dividedBall(const Mat3& axes) {
  Image image;
  image.source = "made.nii";
  image.axes = axes * kMm;
  image.size = {70, 70, 70};
  image.origin = -(axes * Vec3(34.6, 35.3, 34.8)) * kMm;
  const Vec3 tilted = glm::normalize(Vec3(0.12, 0.05, 1));
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.5, 0.8));
  forVoxels(image, [&](const std::array<int, 3>& v) {
    const Vec3 p = image.toWorld(Vec3(v[0], v[1], v[2])) / kMm;
    float label = glm::dot(p, tilted) > 6 ? 3.0F : glm::dot(p, axis) > 0 ? 2.0F : 1.0F;
    if (glm::length(p) > 20) label = 0.0F;
    image.values.push_back(label);
  });
  return image;
}

Mat3 awkwardAxes() {
  Mat3 axes = rotationAbout(Vec3(1, 2, 3), 0.7);
  axes[0] *= -0.8;
  axes[1] *= 1.1;
  axes[2] *= 1.6;
  return axes;
}

TEST(LabelSeam, EveryPointOfADividedBallIsInOnePart) {
  checkSeams("ball", dividedBall(Mat3(1.0)));
  checkSeams("stretched", dividedBall(awkwardAxes()));
  Mat3 thick(1.0);
  thick[2] *= 3.0;
  checkSeams("slices", dividedBall(thick));
}

void checkScan(const char* name, const std::string& file, bool by_themselves) {
  PALPATE_NEEDS_SCAN(file);
  checkSeams(name, readNifti(file), by_themselves);
}

TEST(LabelSeam, EveryPointOfABrainsNucleiIsInOnePart) { checkSeams("nuclei", test::deepBrain()); }

TEST(LabelSeam, EveryPointOfTheVertebraIsInOnePart) {
  checkScan("vertebra", palpate::testing::scanPath("vertebra/subregions.nii.gz"), true);
}

TEST(LabelSeam, EveryPointOfTheAbdomenIsInOnePart) {
  // Its grids without a scene are tested by LabelSurface.AbdomenKeepsVolumesAndWalls.
  checkScan("abdomen", palpate::testing::scanPath("abdomen/example_seg.nii.gz"), false);
}

TEST(LabelSeam, NothingIsUnitedWhereNoLabelsMeet) {
  Image image = dividedBall(Mat3(1.0));
  LabelSurfaces alone(image, {{1, 2, 3}});
  EXPECT_FALSE(alone.united(0.0, {}).has_value());
  // A layer inside another one does not limit it, nor the reverse: they are not neighbors.
  LabelSurfaces nested(image, {{1, 2, 3}, {2}});
  EXPECT_FALSE(nested.united(0.0, {}).has_value());
}

// A layer with a common label is not a neighbor, and its voxels do not belong to the rest either.
// So a layer that is part of another one keeps its own surface where it meets only that layer, and
// shares its wall with a third one.
TEST(LabelSeam, ALayerWithinAnotherKeepsItsOwnSurface) {
  const Image image = dividedBall(Mat3(1.0));
  LabelSurfaces nested(image, {{1, 2}, {2}, {3}});
  LabelSurfaces apart(image, {{1}, {2}, {3}});
  const FieldPtr whole = gridField(nested.surface(0, 0.0, {}));
  const FieldPtr part = gridField(nested.surface(1, 0.0, {}));
  const FieldPtr same = gridField(apart.surface(1, 0.0, {}));
  const FieldPtr cap = gridField(nested.surface(2, 0.0, {}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-14, 14);
  int at_wall = 0, within = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = Vec3(place(random), place(random), place(random)) * kMm;
    if (glm::length(p) > 15 * kMm) continue;
    const double value = part->value(p) / kMm;
    if (std::abs(value) > 1.0) continue;
    if (cap->value(p) > 4 * kMm) {
      // Its wall to label 1 is its own smoothed surface, not the mean of both.
      EXPECT_NEAR(value, same->value(p) / kMm, 0.2);
      EXPECT_LT(whole->value(p), 0.0);
      ++within;
    } else if (std::abs(cap->value(p)) < 1 * kMm && same->value(p) < 1 * kMm &&
               glm::dot(p, Vec3(0.3, 0.5, 0.8)) > 5 * kMm) {
      EXPECT_NEAR(value, -cap->value(p) / kMm, 0.2);
      ++at_wall;
    }
  }
  EXPECT_GT(within, 100);
  EXPECT_GT(at_wall, 100);
}

// Along the line inside the ball where three parts meet, starting from each part in turn. With all
// walls between the parts open, a probe that is dragged along and across the line never leaves the
// parts.
TEST(LabelSeam, AProbeAlongTheLineOfThreePartsNeverFallsOut) {
  const Image image = dividedBall(Mat3(1.0));
  LabelSurfaces surfaces(image, {{1}, {2}, {3}});
  SceneDescription description;
  for (std::size_t n = 0; n < 3; ++n) {
    LayerDescription layer;
    layer.name = std::string(1, static_cast<char>('a' + n));
    layer.inside = std::make_shared<FieldSource>(
        gridField(surfaces.surface(n, 0.0, {}, {}, LabelEdge::kLapped)));
    layer.label_group = "image";
    layer.labels = {static_cast<int>(n) + 1};
    description.layers.push_back(std::move(layer));
  }
  description.start_region = "a";
  PortDescription port;
  port.name = "all";
  port.from = "a, b, c";
  port.to = "a, b, c";
  description.ports = {port};
  const ScenePtr open = compile(description);
  description.ports.clear();
  const ScenePtr closed = compile(description);

  const Vec3 tilted = glm::normalize(Vec3(0.12, 0.05, 1));
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.5, 0.8));
  // The line in both planes: tilted . p = 6, axis . p = 0.
  const Vec3 along = glm::normalize(glm::cross(tilted, axis));
  const double c = glm::dot(tilted, axis);
  const Vec3 foot = (6.0 * tilted - 6.0 * c * axis) / (1.0 - c * c);
  for (const bool is_open : {true, false}) {
    const auto renderer = makeRenderer(is_open ? open : closed);
    const Vec3 start = foot - 8.0 * tilted - 4.0 * axis;
    std::array<int, 4> seen{};
    Vec3 last = start;
    constexpr int kTicks = 12000;
    for (int n = 0; n <= kTicks; ++n) {
      // Half the ball's width along the line, in circles of at most a voxel around it, slowly.
      const double t = static_cast<double>(n) / kTicks;
      const double radius = 0.02 + 1.2 * t;
      const double turn = 400.0 * t;
      const Vec3 u = glm::normalize(tilted - c * axis);
      Vec3 p = foot + 10.0 * std::sin(9.0 * t) * along +
               radius * (std::cos(turn) * axis + std::sin(turn) * u);
      if (n < 200) p = start + (p - start) * (n / 200.0);
      const TickResult tick = renderer->update({p * kMm, (p - last) * kMm / 1e-3, 1e-3});
      last = p;
      ASSERT_NE(tick.region, kOutside) << "tick " << n << (is_open ? ", open" : ", closed");
      ASSERT_NE(open->regionAt(tick.proxy), kOutside) << "tick " << n;
      if (is_open) {
        ASSERT_LT(glm::length(tick.proxy - p * kMm), 1e-7)
            << "tick " << n << ": nothing in the way";
      }
      ++seen[tick.region];
    }
    if (is_open) {
      for (std::size_t region = 1; region < 4; ++region) EXPECT_GT(seen[region], 300) << region;
    } else {
      EXPECT_EQ(seen[1], kTicks + 1);
    }
  }
}

}  // namespace
}  // namespace palpate::vdb
