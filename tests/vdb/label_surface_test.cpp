// Smooth surfaces from voxel labels, compared with closed forms, and shared by neighbors.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/scan_surface.h"
#include "support/scan_folder.h"
#include "vdb/debian_scans.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return unitOr(Vec3(normal(random), normal(random), normal(random)), Vec3(1, 0, 0));
}

/// A shape, given by its distance and by points of its surface with their normals; lengths in mm.
struct Shape {
  const char* name;
  std::function<double(const Vec3&)> distance;
  std::function<std::pair<Vec3, Vec3>(std::mt19937&)> surface;
  Box3 box;  ///< of the image
};

Shape ballShape(const Vec3& center, double radius) {
  return {"ball", [=](const Vec3& p) { return glm::length(p - center) - radius; },
          [=](std::mt19937& random) {
            const Vec3 n = direction(random);
            return std::pair(center + radius * n, n);
          },
          Box3{Vec3(-radius - 9), Vec3(radius + 9)}};
}

Shape torusShape(const Vec3& center, const Vec3& axis, double ring, double tube) {
  const auto outwards = [=](const Vec3& p) {
    const Vec3 flat = p - center - glm::dot(p - center, axis) * axis;
    return p - center - ring * glm::normalize(flat);
  };
  return {"torus", [=](const Vec3& p) { return glm::length(outwards(p)) - tube; },
          [=](std::mt19937& random) {
            std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
            const Vec3 any = direction(random);
            const Vec3 u = glm::normalize(any - glm::dot(any, axis) * axis);
            const double t = angle(random);
            const Vec3 n = std::cos(t) * u + std::sin(t) * axis;
            return std::pair(center + ring * u + tube * n, n);
          },
          Box3{Vec3(-ring - tube - 9), Vec3(ring + tube + 9)}};
}

/// The half-space below a plane; measured in the middle of a cube of 84 mm.
Shape planeShape(const Vec3& center, const Vec3& normal) {
  return {"plane", [=](const Vec3& p) { return glm::dot(p - center, normal); },
          [=](std::mt19937& random) {
            std::uniform_real_distribution<double> place(-26, 26);
            const Vec3 d(place(random), place(random), place(random));
            return std::pair(center + d - glm::dot(d, normal) * normal, normal);
          },
          Box3{Vec3(-42), Vec3(42)}};
}

/// An image in which the shape's voxels have label 1. `axes` in mm; the image covers the shape's
/// box.
Image voxelsOf(const Shape& shape, const Mat3& axes) {
  Image image;
  image.source = "made.nii";
  image.axes = axes * kMm;
  const Mat3 to_index = glm::inverse(axes);
  Box3 range;
  for (int c = 0; c < 8; ++c) {
    range.include(to_index * Vec3(c & 1 ? shape.box.lo.x : shape.box.hi.x,
                                  c & 2 ? shape.box.lo.y : shape.box.hi.y,
                                  c & 4 ? shape.box.lo.z : shape.box.hi.z));
  }
  for (std::size_t a = 0; a < 3; ++a) {
    image.size[a] = static_cast<int>(range.size()[static_cast<int>(a)]) + 1;
  }
  const Vec3 origin = axes * range.lo;
  image.origin = origin * kMm;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        image.values.push_back(shape.distance(origin + axes * Vec3(i, j, k)) < 0 ? 1.0F : 0.0F);
      }
    }
  }
  return image;
}

struct Errors {
  double bias =
      0.0;  ///< [mm] mean value on the true surface; positive: the grid's surface is inside
  double rms = 0.0;     ///< [mm]
  double normal = 0.0;  ///< [degree] RMS
  double worst = 0.0;   ///< [degree]
};

Errors errorsOf(const Field& field, const Shape& shape) {
  std::mt19937 random(5);
  Errors errors;
  constexpr int kPoints = 5000;
  for (int i = 0; i < kPoints; ++i) {
    const auto [p, n] = shape.surface(random);
    const FieldSample sample = field.sample(p * kMm);
    const double d = sample.value / kMm;
    const double cosine = glm::dot(unitOr(sample.gradient, -n), n);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
    errors.bias += d / kPoints;
    errors.rms += d * d / kPoints;
    errors.normal += angle * angle / kPoints;
    errors.worst = std::max(errors.worst, angle);
  }
  errors.rms = std::sqrt(errors.rms);
  errors.normal = std::sqrt(errors.normal);
  return errors;
}

Errors measured(const Shape& shape, const Mat3& axes, const char* voxels) {
  const Image image = voxelsOf(shape, axes);
  const FieldPtr field = gridField(surfaceFromLabels(image, {.values = {1}}, {}));
  const Errors errors = errorsOf(*field, shape);
  std::printf("%-6s %-22s normal %.3f degree (worst %.2f), bias %+.4f mm, rms %.4f mm\n",
              shape.name, voxels, errors.normal, errors.worst, errors.bias, errors.rms);
  return errors;
}

const Vec3 kOffCenter(0.13, -0.29, 0.37);
const Vec3 kTilted = glm::normalize(Vec3(0.12, 0.05, 1));
const Vec3 kAxis = glm::normalize(Vec3(0.3, 0.5, 0.8));

TEST(LabelSurface, BallTorusAndTiltedPlaneAtOnce) {
  for (const Shape& shape : {ballShape(kOffCenter, 25), torusShape(kOffCenter, kAxis, 20, 8),
                             planeShape(kOffCenter, kTilted)}) {
    const Errors errors = measured(shape, Mat3(1.0), "1 mm");
    EXPECT_LT(errors.normal, 0.5) << shape.name;
    EXPECT_LT(std::abs(errors.bias), 0.03) << shape.name;
    EXPECT_LT(errors.rms, 0.04) << shape.name;
  }
}

TEST(LabelSurface, ThickSlicesAndAnyOrientation) {
  Mat3 thick(1.0);
  thick[2] *= 3.0;
  Mat3 oblique = rotationAbout(Vec3(1, 2, 3), 0.7);
  Mat3 awkward = oblique;
  awkward[0] *= -0.8;
  awkward[1] *= 1.1;
  awkward[2] *= 1.6;
  for (const Shape& shape : {ballShape(kOffCenter, 25), torusShape(kOffCenter, kAxis, 20, 8),
                             planeShape(kOffCenter, kTilted)}) {
    const Errors turned = measured(shape, oblique, "1 mm, oblique");
    EXPECT_LT(turned.normal, 0.6) << shape.name;
    EXPECT_LT(std::abs(turned.bias), 0.03) << shape.name;
    const Errors stretched = measured(shape, awkward, "0.8 x 1.1 x 1.6 mm");
    EXPECT_LT(stretched.normal, 1.1) << shape.name;
    EXPECT_LT(std::abs(stretched.bias), 0.05) << shape.name;
    // Only outlines of slices 3 mm apart are known; at a ball's poles there are none.
    const Errors sliced = measured(shape, thick, "1 x 1 x 3 mm");
    EXPECT_LT(sliced.normal, 5.5) << shape.name;
    EXPECT_LT(sliced.rms, 0.25) << shape.name;
  }
}

// A ball whose intensity is a sigmoid 1.5 mm wide, with a gradient of intensity: the iso-surface is
// known, and differs from that of the half-way mask.
TEST(ThresholdSurface, IsTheIsoSurfaceOfTheImage) {
  Mat3 thick(1.0);
  thick[2] *= 3.0;
  Mat3 oblique = rotationAbout(Vec3(1, 2, 3), 0.7);
  for (const auto& [axes, name, steepest, tolerance, lean] :
       {std::tuple(Mat3(1.0), "1 mm", 1.5, 0.005, 0.1),
        std::tuple(oblique, "1 mm, oblique", 1.5, 0.005, 0.1),
        std::tuple(thick, "1 x 1 x 3 mm", 3.0, 0.02, 0.6)}) {
    const Shape shape = ballShape(kOffCenter, 22);
    Image image = voxelsOf(shape, axes);
    std::size_t n = 0;
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i, ++n) {
          const double d = shape.distance(image.toWorld(Vec3(i, j, k)) / kMm);
          image.values[n] = static_cast<float>(1000.0 / (1.0 + std::exp(d / steepest)) - 200.0);
        }
      }
    }
    // Where the sigmoid is 1/4: log 3 widths outside the ball.
    const double out = steepest * std::log(3.0);
    const FieldPtr field = gridField(surfaceFromThreshold(image, {.above = 50}, {}));
    const Errors errors = errorsOf(*field, ballShape(kOffCenter, 22 + out));
    std::printf("threshold %-14s normal %.4f degree (worst %.3f), bias %+.5f mm, rms %.5f mm\n",
                name, errors.normal, errors.worst, errors.bias, errors.rms);
    EXPECT_LT(std::abs(errors.bias), tolerance) << name;
    EXPECT_LT(errors.rms, tolerance) << name;
    EXPECT_LT(errors.normal, lean) << name;
  }
}

TEST(ThresholdSurface, RefusesWhatIsNoIntensity) {
  const Image image = voxelsOf(ballShape(kOffCenter, 5), Mat3(1.0));
  for (const double above : {std::nan(""), kInfinity, -kInfinity}) {
    try {
      (void)surfaceFromThreshold(image, {.above = above}, {});
      ADD_FAILURE() << above;
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "scan.threshold");
    }
  }
}

/// A ball of two halves, and a third label that caps one side, so that three parts meet along
/// lines.
Image dividedBall(const Mat3& axes) {
  const Shape ball = ballShape(kOffCenter, 20);
  Image image = voxelsOf(ball, axes);
  std::size_t n = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i, ++n) {
        const Vec3 p = image.toWorld(Vec3(i, j, k)) / kMm - kOffCenter;
        if (image.values[n] == 0.0F) continue;
        image.values[n] = glm::dot(p, kTilted) > 6 ? 3.0F : glm::dot(p, kAxis) > 0 ? 2.0F : 1.0F;
      }
    }
  }
  return image;
}

// A point in the ball is in exactly one of its parts: of the two smallest fields there, one is
// positive and one negative.
TEST(LabelSurface, NeighborsShareOneWallWithoutGapOrOverlap) {
  Mat3 awkward = rotationAbout(Vec3(1, 2, 3), 0.7);
  awkward[0] *= -0.8;
  awkward[1] *= 1.1;
  awkward[2] *= 1.6;
  for (const Mat3& axes : {Mat3(1.0), awkward}) {
    const Image image = dividedBall(axes);
    LabelSurfaces surfaces(image, {{1}, {2}, {3}});
    std::vector<FieldPtr> fields;
    for (std::size_t n = 0; n < 3; ++n) fields.push_back(gridField(surfaces.surface(n, 0.0, {})));
    std::mt19937 random(8);
    std::uniform_real_distribution<double> depth(0, 1);
    const double voxel = fields[0]->featureSize() / kMm;
    double gap = 0.0, overlap = 0.0, apart = 0.0, at_wall = 0.0;
    for (int n = 0; n < 40000; ++n) {
      const Vec3 p = (kOffCenter + 17.0 * std::cbrt(depth(random)) * direction(random)) * kMm;
      std::array<double, 3> f{};
      for (std::size_t a = 0; a < 3; ++a) f[a] = fields[a]->value(p) / kMm / voxel;
      std::sort(f.begin(), f.end());
      gap = std::max(gap, f[0]);
      overlap = std::max(overlap, -f[1]);
      // The third part is farther than a few voxels: a wall between two.
      if (f[2] > 3.0 && std::abs(f[0]) < 1.0) apart = std::max(apart, std::abs(f[0] + f[1]));
      if (f[2] > 3.0 && std::abs(f[0]) < 0.2) at_wall = std::max(at_wall, std::abs(f[0] + f[1]));
    }
    std::printf(
        "three parts of a ball: gap %.4f, overlap %.4f voxel; where two meet %.1e, at their wall "
        "%.1e\n",
        gap, overlap, apart, at_wall);
    // Each layer's grid has its own distances to the shared wall. Along the line where three walls
    // meet, grids round off the edge.
    EXPECT_LT(apart, 0.2);
    EXPECT_LT(at_wall, 0.15);
    EXPECT_LT(gap, 0.35);
    EXPECT_LT(overlap, 0.15);
  }
}

/// Enclosed volume [voxels of the grid] by the spline: near the surface every voxel is divided into
/// 3^3 parts, with a smooth step as wide as a part.
double volumeOf(const LevelSet& grid) {
  const Image image = gridImage(grid);
  const FieldPtr field = gridField(grid);
  const auto h = static_cast<float>(grid.info().voxel_size / grid.info().meters_per_unit);
  double sum = 0.0;
  std::size_t n = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i, ++n) {
        const float value = image.values[n] / h;
        if (std::abs(value) > 1.8F) {
          sum += value < 0.0F ? 1.0 : 0.0;
          continue;
        }
        for (int part = 0; part < 27; ++part) {
          const Vec3 off = (Vec3(part / 9, part / 3 % 3, part % 3) - 1.0) / 3.0;
          const double there = field->value(image.toWorld(Vec3(i, j, k) + off));
          sum += std::clamp(0.5 - 3.0 * there / grid.info().voxel_size, 0.0, 1.0) / 27.0;
        }
      }
    }
  }
  return sum;
}

/// Takes every label of an image as a layer; checks volumes, and that no two layers leave a gap or
/// overlap between adjacent voxels.
void checkScan(const Image& image) {
  std::map<int, std::size_t> counts;
  for (const float value : image.values) ++counts[static_cast<int>(value)];
  counts.erase(0);
  std::vector<int> labels;
  std::vector<std::vector<int>> layers;
  for (const auto& [label, count] : counts) {
    labels.push_back(label);
    layers.push_back({label});
  }
  LabelSurfaces surfaces(image, layers);
  std::map<int, FieldPtr> fields;
  const auto at = [&](const Vec3& index) {
    const auto i = static_cast<int>(index.x), j = static_cast<int>(index.y);
    const auto k = static_cast<int>(index.z);
    const auto [nx, ny, nz] = image.size;
    if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return 0;
    return static_cast<int>(image.at(i, j, k));
  };
  std::uint64_t active = 0;
  for (std::size_t n = 0; n < labels.size(); ++n) {
    const LevelSet grid = surfaces.surface(n, 0.0, {});
    active += grid.info().active_voxels;
    fields[labels[n]] = gridField(grid);
    std::size_t faces = 0, lost = 0, won = 0;
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i) {
          const FieldPtr& field = fields[labels[n]];
          const double off = field->value(image.toWorld(Vec3(i, j, k))) / field->featureSize();
          const bool own = at(Vec3(i, j, k)) == labels[n];
          lost += own && off > 0.3 ? 1U : 0U;
          won += !own && off < -0.3 ? 1U : 0U;
          if (!own) continue;
          for (int a = 0; a < 3; ++a) {
            Vec3 step(0.0);
            step[a] = 1.0;
            faces += at(Vec3(i, j, k) + step) != labels[n] ? 1U : 0U;
            faces += at(Vec3(i, j, k) - step) != labels[n] ? 1U : 0U;
          }
        }
      }
    }
    const double counted = static_cast<double>(counts[labels[n]]);
    const double enclosed = volumeOf(grid);
    // Voxel faces overestimate the area of a surface with all directions by 3 / 2.
    const double area = static_cast<double>(faces) / 1.5;
    std::printf(
        "  label %3d: %7.0f voxels, %9.1f enclosed (%+.2f %%, wall %+.3f voxel), centers %zu lost, "
        "%zu won\n",
        labels[n], counted, enclosed, 100 * (enclosed / counted - 1), (enclosed - counted) / area,
        lost, won);
    // No layer contains another's voxel centers, and walls are within a twentieth of a voxel on
    // average.
    EXPECT_LT(won, 10U) << labels[n];
    EXPECT_LT(std::abs(enclosed - counted), std::max(0.01 * counted, 0.05 * area)) << labels[n];
  }
  std::printf("  %llu active voxels\n", static_cast<unsigned long long>(active));

  double apart = 0.0, gap = 0.0, overlap = 0.0;
  std::size_t walls = 0;
  for (int k = 3; k + 4 < image.size[2]; ++k) {
    for (int j = 3; j + 4 < image.size[1]; ++j) {
      for (int i = 3; i + 4 < image.size[0]; ++i) {
        for (int a = 0; a < 3; ++a) {
          Vec3 step(0.0);
          step[a] = 1.0;
          const Vec3 here(i, j, k);
          const int one = at(here);
          const int two = at(here + step);
          if (one == two || one == 0 || two == 0) continue;
          bool alone = true;
          for (int n = 0; n < 8 * 49 && alone; ++n) {
            const Vec3 near = here + Vec3(n / 49, n / 7 % 7, n % 7) - Vec3(3);
            const int third = at(near);
            alone = third == one || third == two;
          }
          for (const double share : {0.1, 0.35, 0.5, 0.65, 0.9}) {
            const Vec3 p = image.toWorld(here + share * step);
            const double f = fields[one]->value(p) / fields[one]->featureSize();
            const double g = fields[two]->value(p) / fields[two]->featureSize();
            gap = std::max(gap, std::min(f, g));
            overlap = std::max(overlap, -std::max(f, g));
            if (alone) apart = std::max(apart, std::abs(f + g));
          }
          walls += alone ? 1U : 0U;
        }
      }
    }
  }
  // With separate grids, too, each point is in exactly one layer or in the surroundings: the one
  // with the smallest value.
  const FieldPtr united = gridField(surfaces.united(0.0, {}).value());
  std::size_t inner = 0;
  for (int k = 1; k + 2 < image.size[2]; ++k) {
    for (int j = 1; j + 2 < image.size[1]; ++j) {
      for (int i = 1; i + 2 < image.size[0]; ++i) {
        std::map<int, int> near;
        for (int n = 0; n < 64; ++n)
          ++near[at(Vec3(i - 1 + n % 4, j - 1 + n / 4 % 4, k - 1 + n / 16))];
        if (near.size() < 2 || near.contains(0)) continue;
        for (int n = 0; n < 27; ++n) {
          const Vec3 p = image.toWorld(Vec3(i, j, k) + 0.5 * Vec3(n % 3, n / 3 % 3, n / 9));
          bool is_held = false;
          for (const auto& [label, count] : near) {
            is_held = is_held || fields[label]->value(p) <= -united->value(p);
          }
          ASSERT_TRUE(is_held) << i << " " << j << " " << k << ", point " << n;
        }
        ++inner;
      }
    }
  }
  EXPECT_GT(inner, 1000U);
  std::printf(
      "  %zu faces between two labels alone: fields differ by %.2e voxel; everywhere: gap %.3f, "
      "overlap %.3f\n",
      walls, apart, gap, overlap);
  EXPECT_LT(apart, 0.02);
}

/// A slab of label 1 across the image, `thickness` voxels of 1 mm, from z = 12 mm on.
Image slab(int thickness) {
  Image image;
  image.source = "slab.nii";
  image.size = {28, 28, 28};
  image.axes = Mat3(kMm);
  image.values.assign(std::size_t{28} * 28 * 28, 0.0F);
  for (int k = 12; k < 12 + thickness; ++k) {
    for (int j = 4; j < 24; ++j) {
      for (int i = 4; i < 24; ++i) {
        image.values[static_cast<std::size_t>(i + 28 * (j + 28 * k))] = 1.0F;
      }
    }
  }
  return image;
}

// Thin parts are kept, with their volume, where the grid's voxels can hold them; elsewhere the grid
// says how many voxels it lost, and where.
TEST(LabelSurface, ThinPartsAreKeptOrTold) {
  for (const int thickness : {1, 2}) {
    const Image image = slab(thickness);
    const LevelSet kept = surfaceFromLabels(image, {.values = {1}}, {});
    const ScanLoss none = scanLoss(kept.info());
    EXPECT_EQ(none.filled, 0U) << thickness;
    // Rounding at the rim loses no voxel center.
    EXPECT_LE(none.lost, 4U) << thickness;
    const FieldPtr field = gridField(kept);
    for (int i = 8; i < 20; ++i) {
      EXPECT_LT(field->value(Vec3(i, 14, 12) * kMm), -0.1 * kMm) << thickness;
    }
    EXPECT_NEAR(volumeOf(kept), 400.0 * thickness, 0.08 * 400.0 * thickness) << thickness;
  }

  // Voxels of 5 mm have their centers at 10 and 15 mm: the slab at 12 mm is between them, the block
  // above is not.
  const Image both = [] {
    Image image = slab(1);
    for (int k = 20; k < 27; ++k) {
      for (int j = 4; j < 24; ++j) {
        for (int i = 4; i < 24; ++i) {
          image.values[static_cast<std::size_t>(i + 28 * (j + 28 * k))] = 1.0F;
        }
      }
    }
    return image;
  }();
  const LevelSet lossy = surfaceFromLabels(both, {.values = {1}, .voxel_size = 5 * kMm}, {});
  const ScanLoss loss = scanLoss(lossy.info());
  EXPECT_GT(loss.lost, 200U);
  EXPECT_NEAR(loss.place.z, 12 * kMm, 1e-9);
  EXPECT_EQ(lossy.info().metadata.at("lost_voxels"), std::to_string(loss.lost));
  const std::string note = scanLossNote(lossy.info());
  EXPECT_NE(note.find(std::to_string(loss.lost) + " voxels of the scan lost"), std::string::npos)
      << note;
  EXPECT_NE(note.find(" 12) mm"), std::string::npos) << note;
}

TEST(LabelSurface, NucleiOfABrainKeepVolumesAndWalls) { checkScan(test::deepBrain()); }

TEST(LabelSurface, VertebraKeepsVolumesAndWalls) {
  const std::string file = palpate::testing::scanPath("vertebra/subregions.nii.gz");
  PALPATE_NEEDS_SCAN(file);
  checkScan(readNifti(file));
}

TEST(LabelSurface, AbdomenKeepsVolumesAndWalls) {
  const std::string file = palpate::testing::scanPath("abdomen/example_seg.nii.gz");
  PALPATE_NEEDS_SCAN(file);
  checkScan(readNifti(file));
}

}  // namespace
}  // namespace palpate::vdb
