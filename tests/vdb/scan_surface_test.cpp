// Surfaces from thresholds and labels: their place and orientation, and the parts that they keep.
#include "palpate/vdb/scan_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "palpate/core/error.h"
#include "support/scan_folder.h"
#include "vdb/debian_scans.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

/// An image of `size` voxels with `axes`; the value is a function of the voxel's indices.
Image imageOf(std::array<int, 3> size, const Mat3& axes, const Vec3& origin,
              const std::function<double(const Vec3&)>& value) {
  Image image;
  image.source = "made.nii";
  image.size = size;
  image.axes = axes;
  image.origin = origin;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        image.values.push_back(static_cast<float>(value(Vec3(i, j, k))));
      }
    }
  }
  return image;
}

Image cubeImage(int n, const std::function<double(const Vec3&)>& value) {
  return imageOf({n, n, n}, Mat3(kMm), Vec3(0.0), value);
}

// Trilinear sampling: a flat wall is exact to rounding, however near the next edge is.
FieldPtr thresholdField(const Image& image, ThresholdOptions options) {
  return gridField(surfaceFromThreshold(image, options, {}), Sampler::kAccessor);
}

FieldPtr labelField(const Image& image, std::vector<int> values) {
  return gridField(surfaceFromLabels(image, {.values = std::move(values)}, {}), Sampler::kAccessor);
}

/// Enclosed volume [m^3]: with a smooth step as wide as the sampling, over the field's box. Where
/// the surface is smooth on that scale the error is of second order.
double volumeOf(const Field& field, double step) {
  const Box3 box = field.bounds().grownBy(2.0 * step);
  double sum = 0.0;
  for (double z = box.lo.z; z < box.hi.z; z += step) {
    for (double y = box.lo.y; y < box.hi.y; y += step) {
      for (double x = box.lo.x; x < box.hi.x; x += step) {
        sum += std::clamp(0.5 - field.value(Vec3(x, y, z)) / step, 0.0, 1.0);
      }
    }
  }
  return sum * step * step * step;
}

struct BallErrors {
  double bias = 0.0;    ///< [m] mean value on the true sphere; positive: the baked ball is smaller
  double rms = 0.0;     ///< [m]
  double normal = 0.0;  ///< [degrees] RMS
};

BallErrors errorsOnSphere(const Field& field, const Vec3& center, double radius) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  BallErrors errors;
  constexpr int kPoints = 4000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 n = unitOr(Vec3(normal(random), normal(random), normal(random)), Vec3(1, 0, 0));
    const FieldSample sample = field.sample(center + radius * n);
    errors.bias += sample.value / kPoints;
    errors.rms += sample.value * sample.value / kPoints;
    const double angle = std::acos(std::clamp(glm::dot(unitOr(sample.gradient, -n), n), -1.0, 1.0));
    errors.normal += angle * angle / kPoints;
  }
  errors.rms = std::sqrt(errors.rms);
  errors.normal = std::sqrt(errors.normal) * 180.0 / std::numbers::pi;
  return errors;
}

/// Oblique, anisotropic and left-handed: 0.8 x 1.1 x 1.6 mm, rotated about (1, 2, 3), mirrored.
Mat3 awkwardAxes() {
  Mat3 axes = rotationAbout(Vec3(1, 2, 3), 0.7);
  axes[0] *= -0.8 * kMm;
  axes[1] *= 1.1 * kMm;
  axes[2] *= 1.6 * kMm;
  return axes;
}

// A ball with an awkward affine, once with its distance as intensity and once as labels. Spacings
// are 0.04 to 0.08 of the radius.
TEST(ScanSurface, BallThroughAnAwkwardAffine) {
  const Mat3 axes = awkwardAxes();
  ASSERT_LT(glm::determinant(axes), 0.0);
  const Vec3 origin = Vec3(31, -17, 5) * kMm;
  const double radius = 20 * kMm;
  const Vec3 center = axes * Vec3(33.3, 24.1, 17.7) + origin;
  const auto depth = [&](const Vec3& index) {
    return (radius - glm::length(axes * index + origin - center)) / kMm;
  };
  const Image gray =
      imageOf({68, 50, 36}, axes, origin, [&](const Vec3& i) { return 100 + depth(i); });
  const Image label =
      imageOf({68, 50, 36}, axes, origin, [&](const Vec3& i) { return depth(i) > 0 ? 7 : 0; });

  const FieldPtr from_gray = thresholdField(gray, {.above = 100});
  const FieldPtr from_label = labelField(label, {7});
  EXPECT_DOUBLE_EQ(from_gray->featureSize(), 0.8 * kMm);  // voxels of the smallest spacing
  const BallErrors g = errorsOnSphere(*from_gray, center, radius);
  const BallErrors l = errorsOnSphere(*from_label, center, radius);
  std::printf(
      "ball R = 20 mm, voxels 0.8 x 1.1 x 1.6 mm, oblique, left-handed\n"
      "  threshold: bias %+.3f mm, rms %.3f mm, normal %.2f degrees\n"
      "  labels:    bias %+.3f mm, rms %.3f mm, normal %.2f degrees\n",
      g.bias / kMm, g.rms / kMm, g.normal, l.bias / kMm, l.rms / kMm, l.normal);
  // Chords of triangles as long as a voxel's diagonal (d = 2.1 mm) are up to d^2 / (8 R) = 0.028 mm
  // too deep, and a linear interpolant of the distance (step h = 0.8 mm) adds h^2 / (4 R) = 0.008
  // mm. Facets are tilted by up to d / (2 R) = 3 degrees against the sphere, 1.5 on average.
  EXPECT_LT(std::abs(g.bias), 0.036 * kMm);
  EXPECT_LT(g.rms, 0.04 * kMm);
  EXPECT_LT(g.normal, 1.5);
  // Labels tell the sphere only to a voxel: measured errors, with a margin of a fifth.
  EXPECT_LT(std::abs(l.bias), 0.07 * kMm);
  EXPECT_LT(l.rms, 0.12 * kMm);
  EXPECT_LT(l.normal, 5.0);
  // The inside is negative.
  EXPECT_LT(from_gray->value(center), 0.0);
  EXPECT_LT(from_label->value(center), 0.0);
}

TEST(ScanSurface, ThresholdFollowsTheIntensityBetweenVoxels) {
  // A ramp of 40 per voxel along x crosses 100 at x = 7.3; the other borders are the image's.
  const Image image = cubeImage(16, [](const Vec3& i) { return 100 + 40 * (7.3 - i.x); });
  const FieldPtr field = thresholdField(image, {.above = 100});
  for (const double y : {3.0, 7.4, 12.0}) {
    EXPECT_NEAR(field->value(Vec3(7.3, y, 8.2) * kMm), 0.0, 1e-6 * kMm);
    EXPECT_NEAR(field->sample(Vec3(7.3, y, 8.2) * kMm).gradient.x, 1.0, 1e-5);
  }
}

TEST(ScanSurface, IsClosedHalfAVoxelBeyondTheImagesBorder) {
  for (const bool labels : {false, true}) {
    const Image image =
        imageOf({10, 12, 14}, Mat3(2 * kMm), Vec3(-9, 4, 30) * kMm, [](const Vec3&) { return 1; });
    const FieldPtr field = labels ? labelField(image, {1}) : thresholdField(image, {.above = 0});
    const Vec3 middle = image.toWorld(Vec3(4.5, 5.5, 6.5));
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 wall = middle;
        wall[axis] += side * (image.size[static_cast<std::size_t>(axis)]) * kMm;
        EXPECT_NEAR(field->value(wall), 0.0, 1e-6 * kMm) << axis << side;
        EXPECT_NEAR(field->sample(wall).gradient[axis], side, 1e-5);
      }
    }
    // All voxels, minus what the grid rounds off along the twelve edges (144 voxels): less than a
    // quarter of a voxel's face for each voxel of edge.
    const double volume = volumeOf(*field, kMm);
    EXPECT_LT(volume, 10 * 12 * 14 * 8e-9);
    EXPECT_GT(volume, (10 * 12 * 14 - 36) * 8e-9);
  }
}

double ball(const Vec3& p, const Vec3& center, double radius) {
  return radius - glm::length(p - center);
}

TEST(ScanSurface, KeepsTheLargestPieceOrAll) {
  const Image image = cubeImage(40, [](const Vec3& p) {
    return std::max(ball(p, Vec3(14, 14, 14), 9), ball(p, Vec3(31, 31, 31), 5));
  });
  const FieldPtr largest = thresholdField(image, {.above = 0});
  const FieldPtr all = thresholdField(image, {.above = 0, .largest_component = false});
  EXPECT_LT(largest->value(Vec3(14, 14, 14) * kMm), 0.0);
  EXPECT_GT(largest->value(Vec3(31, 31, 31) * kMm), 0.0);
  EXPECT_LT(all->value(Vec3(14, 14, 14) * kMm), 0.0);
  EXPECT_LT(all->value(Vec3(31, 31, 31) * kMm), 0.0);
}

// A thick shell; with `duct` an air passage leads into its cavity.
Image shell(bool duct) {
  return cubeImage(44, [duct](const Vec3& p) {
    const double wall = std::min(ball(p, Vec3(21.5), 18), -ball(p, Vec3(21.5), 9));
    const bool in_duct = duct && p.x > 21.5 && std::hypot(p.y - 21.5, p.z - 21.5) < 3.0;
    return in_duct ? -5.0 : wall;
  });
}

TEST(ScanSurface, FillsEnclosedCavitiesOnRequestAndLeavesOpenOnes) {
  const Vec3 inside_cavity = Vec3(21.5) * kMm;
  const Vec3 in_wall = Vec3(21.5, 21.5, 8.0) * kMm;
  const FieldPtr hollow = thresholdField(shell(false), {.above = 0});
  EXPECT_GT(hollow->value(inside_cavity), 0.0);
  EXPECT_LT(hollow->value(in_wall), 0.0);
  const FieldPtr filled = thresholdField(shell(false), {.above = 0, .fill = true});
  EXPECT_LT(filled->value(inside_cavity), 0.0);
  EXPECT_LT(filled->value(Vec3(21.5, 21.5, 12.4) * kMm), 0.0);  // the place of the cavity's wall
  const FieldPtr open = thresholdField(shell(true), {.above = 0, .fill = true});
  EXPECT_GT(open->value(inside_cavity), 0.0);
  EXPECT_LT(open->value(in_wall), 0.0);
}

// An air passage whose voxels share only edges is open; one whose voxels share only corners is
// closed.
TEST(ScanSurface, AirPassesEdgesButNotCorners) {
  for (const bool corner : {false, true}) {
    const Image image = cubeImage(15, [corner](const Vec3& p) {
      const bool cavity = std::max({std::abs(p.x - 7), std::abs(p.y - 7), std::abs(p.z - 7)}) < 2.5;
      // From the cavity's edge (or corner) at 9 outwards: (10, 10, 9), (11, 11, 9), ...
      const bool path = p.x == p.y && p.x > 9 && (corner ? p.z == p.x : p.z == 9);
      return cavity || path ? 0 : 1;
    });
    const FieldPtr field = thresholdField(image, {.above = 0.5, .fill = true});
    EXPECT_EQ(field->value(Vec3(7 * kMm)) > 0.0, !corner);
  }
}

TEST(ScanSurface, NaNIsBackgroundAndInfinityIsInside) {
  Image image = cubeImage(24, [](const Vec3& p) { return ball(p, Vec3(11.5), 8); });
  const auto at = [&](int i, int j, int k) {
    return static_cast<std::size_t>(i + 24 * (j + 24 * k));
  };
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 4; ++i) image.values[at(i, j, k)] = std::nanf("");
      for (int i = 4; i < 6; ++i) {
        if (image.values[at(i, j, k)] > 0) image.values[at(i, j, k)] = INFINITY;
      }
    }
  }
  const FieldPtr field = thresholdField(image, {.above = 0});
  EXPECT_LT(field->value(Vec3(11.5) * kMm), 0.0);
  EXPECT_LT(field->value(Vec3(5, 11.5, 11.5) * kMm), 0.0);
  EXPECT_GT(field->value(Vec3(2, 11.5, 11.5) * kMm), 0.0);
}

TEST(ScanSurface, KeepsASheetOneVoxelThick) {
  const Image image = cubeImage(24, [](const Vec3& p) {
    return std::abs(p.x - 12) < 8 && std::abs(p.y - 12) < 8 && p.z == 12 ? 3 : 0;
  });
  const FieldPtr field = labelField(image, {3});
  for (const double x : {8.0, 12.0, 15.0}) {
    EXPECT_LT(field->value(Vec3(x, 12, 12) * kMm), 0.0);
    EXPECT_GT(field->value(Vec3(x, 12, 13) * kMm), 0.0);
    EXPECT_GT(field->value(Vec3(x, 12, 11) * kMm), 0.0);
  }
}

TEST(ScanSurface, RecordsWhatItIs) {
  const Image image =
      cubeImage(20, [](const Vec3& p) { return ball(p, Vec3(9.5), 6) > 0 ? 4 : 0; });
  BakeOptions bake;
  bake.name = "organ/surface";
  bake.metadata["layer"] = "organ";
  const LevelSet labels = surfaceFromLabels(image, {.values = {4, 9}}, bake);
  EXPECT_EQ(labels.info().name, "organ/surface");
  EXPECT_EQ(labels.info().metadata.at("frame"), "RAS");
  EXPECT_EQ(labels.info().metadata.at("source"), "made.nii");
  EXPECT_EQ(labels.info().metadata.at("labels"), "4, 9");
  EXPECT_EQ(labels.info().metadata.at("layer"), "organ");
  const LevelSet fine =
      surfaceFromThreshold(image, {.above = 1.5, .fill = true, .voxel_size = 0.5 * kMm}, bake);
  EXPECT_NEAR(fine.info().voxel_size, 0.5 * kMm, 1e-12);
  EXPECT_EQ(fine.info().metadata.at("threshold"), "above 1.5, largest piece, filled");
}

TEST(ScanSurface, BelowIsAboveOfTheNegative) {
  const auto wavy = [](const Vec3& p) {
    return glm::length(p - Vec3(5.2, 4.9, 5.4)) + 0.3 * std::sin(p.x);
  };
  const Image image = cubeImage(12, wavy);
  const Image negative = cubeImage(12, [&](const Vec3& p) { return -wavy(p); });
  const LevelSet below = surfaceFromThreshold(image, {.below = 3.0}, {});
  EXPECT_EQ(below.info().metadata.at("threshold"), "below 3, largest piece");
  const FieldPtr one = gridField(below, Sampler::kAccessor);
  const FieldPtr other = thresholdField(negative, {.above = -3.0});
  for (double x = 1.0; x < 10.0; x += 0.37) {
    const Vec3 p = Vec3(x, 5.0, 0.5 * x + 2.0) * kMm;
    EXPECT_EQ(one->value(p), other->value(p)) << x;
  }
  try {
    (void)surfaceFromThreshold(image, {.below = -1.0}, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "scan.empty");
    EXPECT_NE(std::string(error.what()).find("smallest value is"), std::string::npos);
  }
}

TEST(ScanSurface, TellsWhenNothingIsThere) {
  const Image image = cubeImage(6, [](const Vec3& p) { return p.x; });
  try {
    (void)thresholdField(image, {.above = 5});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "scan.empty");
    EXPECT_EQ(error.problem().file, "made.nii");
    EXPECT_NE(std::string(error.what()).find("largest value is 5"), std::string::npos);
  }
  try {
    (void)labelField(image, {17, 20});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "scan.empty");
    EXPECT_NE(std::string(error.what()).find("17, 20"), std::string::npos);
  }
  EXPECT_THROW((void)labelField(image, {}), Error);
}

TEST(ScanSurface, ReportsProgressThatOnlyGrowsAndStopsWhenTold) {
  const Image image = cubeImage(30, [](const Vec3& p) { return ball(p, Vec3(14.5), 10); });
  double last = 0.0;
  int calls = 0;
  (void)surfaceFromThreshold(image, {.above = 0}, {}, [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    ++calls;
    return true;
  });
  ASSERT_GE(calls, 4);
  for (int stop_at = 1; stop_at <= 4; ++stop_at) {
    int seen = 0;
    try {
      (void)surfaceFromThreshold(image, {.above = 0}, {},
                                 [&](std::string_view, double) { return ++seen < stop_at; });
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
      EXPECT_EQ(seen, stop_at);
    }
  }
}

/// Checks named parts of an image with cubic voxels: volume, and number of voxel centers on the
/// wrong side.
void expectVolumesKept(const Image& image, const NameTable& names,
                       const std::vector<std::string>& parts) {
  for (const std::string& name : parts) {
    const std::vector<int> values = resolveLabels({name}, names, "labels.csv");
    ASSERT_EQ(values.size(), 1U);
    const auto is_in = [&](int i, int j, int k) {
      const auto [nx, ny, nz] = image.size;
      const bool in_image = i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz;
      return in_image && image.at(i, j, k) == static_cast<float>(values[0]);
    };
    std::size_t voxels = 0;
    std::size_t outside = 0;
    std::size_t faces = 0;
    double worst = 0.0;
    const FieldPtr field = labelField(image, values);
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i) {
          if (!is_in(i, j, k)) continue;
          ++voxels;
          faces += 6U - static_cast<unsigned>(is_in(i - 1, j, k) + is_in(i + 1, j, k) +
                                              is_in(i, j - 1, k) + is_in(i, j + 1, k) +
                                              is_in(i, j, k - 1) + is_in(i, j, k + 1));
          const double value = field->value(image.toWorld(Vec3(i, j, k)));
          outside += value > 0.0 ? 1U : 0U;
          worst = std::max(worst, value);
        }
      }
    }
    ASSERT_GT(voxels, 200U) << name;
    const double spacing = glm::length(image.axes[0]);
    const double counted = static_cast<double>(voxels) * std::pow(spacing, 3.0);
    const double enclosed = volumeOf(*field, 0.5 * spacing);
    // Voxel faces overestimate the area of a surface with all directions by 3 / 2.
    const double area = static_cast<double>(faces) * spacing * spacing / 1.5;
    const double offset = (enclosed - counted) / area / spacing;
    std::printf(
        "  %-13s %6zu voxels, %8.2f ml counted, %8.2f ml enclosed (%+.1f %%: wall %+.3f voxel off "
        "in the mean), %.1f %% of the voxel centers outside, by %.2f voxel at most\n",
        name.c_str(), voxels, counted * 1e6, enclosed * 1e6, 100 * (enclosed / counted - 1), offset,
        100.0 * static_cast<double>(outside) / static_cast<double>(voxels), worst / spacing);
    // The label ball with R = 20 mm above has 0.07 / 0.8 = 0.09; the aorta has a radius of 3.5
    // voxels.
    EXPECT_LT(std::abs(offset), 0.2) << name;
    EXPECT_LT(worst, 0.5 * spacing) << name;
  }
}

TEST(ScanSurface, FiveNucleiByNameKeepTheirVolume) {
  // Caudate and hippocampus reach beyond these voxels, and end there in flat walls.
  expectVolumesKept(test::deepBrain(), readLabelTable(test::mricron("aal.nii.txt")).names,
                    {"Thalamus_L", "Putamen_L", "Pallidum_L", "Hippocampus_L", "Caudate_L"});
}

TEST(ScanSurface, FiveOrgansByNameKeepTheirVolume) {
  const std::string folder = palpate::testing::scanPath("abdomen");
  PALPATE_NEEDS_SCAN(folder);
  expectVolumesKept(readNifti(folder + "/example_seg.nii.gz"),
                    readLabelTable(folder + "/labels.csv").names,
                    {"liver", "spleen", "kidney_right", "stomach", "aorta"});
}

}  // namespace
}  // namespace palpate::vdb
