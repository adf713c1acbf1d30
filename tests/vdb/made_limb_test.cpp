// A synthetic limb of three cylinders, oblique in oblique voxels: its place in files, and the place
// of its walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "itk/itk_image.h"
#include "palpate/vdb/scan_surface.h"
#include "vdb/made_scans.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;
using test::Limb;

constexpr double kMm = 1e-3;

std::map<double, std::size_t> histogramOf(const Image& image) {
  std::map<double, std::size_t> counts;
  for (const float value : image.values) ++counts[static_cast<double>(value)];
  return counts;
}

Vec3 cornerOf(const Image& image, int corner) {
  Vec3 index(0.0);
  for (int a = 0; a < 3; ++a) {
    index[a] = (corner >> a & 1) * (image.size[static_cast<std::size_t>(a)] - 1);
  }
  return index;
}

/// Largest distance between corresponding corners of two images [mm].
double apart(const Image& a, const Image& b) {
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index = cornerOf(a, corner);
    worst = std::max(worst, glm::length(a.toWorld(index) - b.toWorld(index)) / kMm);
  }
  return worst;
}

double apart(const Image& a, const std::array<double, 12>& affine) {
  Image itk;
  for (int r = 0; r < 3; ++r) {
    const auto row = static_cast<std::size_t>(4 * r);
    for (std::size_t c = 0; c < 3; ++c) itk.axes[static_cast<int>(c)][r] = affine[row + c] * kMm;
    itk.origin[r] = affine[row + 3] * kMm;
  }
  return apart(a, itk);
}

TEST(MadeLimb, IsOnePlaceInNiftiNrrdAndDicom) {
  const TempFolder folder;
  const Image made = Limb().scan(test::obliqueAxes(Vec3(1.1, 1.3, 1.6)));
  const Image nifti = readImage(test::writeNifti(made, folder, "limb.nii.gz"));
  const std::string nrrd_file = test::writeNrrd(made, folder, "limb.nrrd");
  const std::string series = test::writeDicom(made, folder, "series");
  const Image nrrd = readImage(nrrd_file);
  const Image dicom = readImage(series);
  for (const Image* image : {&nifti, &nrrd, &dicom}) {
    EXPECT_EQ(image->size, made.size);
    EXPECT_EQ(image->values, made.values);
    // NIfTI holds single precision, 100 mm to 24 bits; the other formats 12 digits.
    EXPECT_LT(apart(*image, made), 2e-5);
  }
  const test::ItkImage itk = test::readWithItk(nrrd_file);
  EXPECT_LT(apart(nrrd, itk.affine), 1e-8);
  EXPECT_EQ(histogramOf(nrrd), itk.histogram);
  const test::ItkImage slices = test::readSeriesWithItk(series);
  EXPECT_EQ(dicom.size, slices.size);
  EXPECT_LT(apart(dicom, slices.affine), 1e-5);
  EXPECT_EQ(histogramOf(dicom), slices.histogram);
}

TEST(MadeLimb, LabelsOfOneGridLieOnTheSlicesOfAnother) {
  const TempFolder folder;
  const Limb limb;
  // The labels are mirrored: in many files x runs from right to left.
  const std::string labels = test::writeNifti(
      limb.labels(test::obliqueAxes(Vec3(-1.5, 1.5, 1.5), -0.3)), folder, "labels.nii.gz");
  const std::string series =
      test::writeDicom(limb.scan(test::obliqueAxes(Vec3(1, 1.2, 1.4))), folder, "series");
  const Image label = readImage(labels);
  const Image ct = readImage(series);
  double sum = 0.0, truth = 0.0;
  std::size_t count = 0;
  for (int k = 0; k < label.size[2]; ++k) {
    for (int j = 0; j < label.size[1]; ++j) {
      for (int i = 0; i < label.size[0]; ++i) {
        if (label.at(i, j, k) != 1.0F) continue;
        const Vec3 p = label.toWorld(Vec3(i, j, k));
        const Vec3 there = glm::round(ct.toIndex(p));
        sum += static_cast<double>(
            ct.at(static_cast<int>(there.x), static_cast<int>(there.y), static_cast<int>(there.z)));
        truth += limb.ct(p / kMm);
        ++count;
      }
    }
  }
  const double mean = sum / static_cast<double>(count);
  const auto expected = test::askPython("mean", {series, labels, "1", "1"});
  EXPECT_EQ(static_cast<double>(count), expected.at(0).at(1));
  EXPECT_NEAR(mean, expected[0][0], 1e-6);
  // Half a voxel off, to both sides equally often; if the labels were at another place, muscle
  // would enter the mean.
  EXPECT_NEAR(mean, truth / static_cast<double>(count), 10.0);
  // pi r^2 l of 1.5 mm voxels.
  const double voxels = std::numbers::pi * Limb::kBone * Limb::kBone * 2.0 * Limb::kHalf / 3.375;
  EXPECT_NEAR(static_cast<double>(count) / voxels, 1.0, 0.02);
}

/// Offset of a field's surface from a cylinder around the limb, away from its ends: mean and worst
/// [mm].
struct Offset {
  double mean = 0.0;
  double worst = 0.0;
};
Offset offsetOf(const Field& field, const Limb& limb, double radius) {
  Offset offset;
  constexpr int kPoints = 2000;
  for (int n = 0; n < kPoints; ++n) {
    const double along = (n % 41 / 20.0 - 1.0) * (Limb::kHalf - 5.0);
    const Vec3 p = limb.center + along * limb.axis + radius * limb.outwards(0.7 * n);
    const double value = field.value(p * kMm) / kMm;
    offset.mean += value / kPoints;
    offset.worst = std::max(offset.worst, std::abs(value));
  }
  return offset;
}

/// Enclosed volume [mm^3], each cube of half a millimeter by its share.
double volumeOf(const Field& field) {
  constexpr double kStep = 0.5 * kMm;
  const Box3 box = field.bounds().grownBy(kStep);
  double sum = 0.0;
  for (double z = box.lo.z; z < box.hi.z; z += kStep) {
    for (double y = box.lo.y; y < box.hi.y; y += kStep) {
      for (double x = box.lo.x; x < box.hi.x; x += kStep) {
        sum += std::clamp(0.5 - field.value(Vec3(x, y, z)) / kStep, 0.0, 1.0);
      }
    }
  }
  return sum * 0.125;
}

TEST(MadeLimb, WallsOfItsLabelsAreItsCylinders) {
  const TempFolder folder;
  const Limb limb;
  const Image image = readImage(
      test::writeNifti(limb.labels(test::obliqueAxes(Vec3(1, 1, 1))), folder, "limb.nii.gz"));
  LabelSurfaces surfaces(image, {{1}, {2}, {3}});
  const FieldPtr bone = gridField(surfaces.surface(0, 0.0, {}));
  const FieldPtr muscle = gridField(surfaces.surface(1, 0.0, {}));
  const FieldPtr fat = gridField(surfaces.surface(2, 0.0, {}));
  const std::array<std::pair<const Field*, double>, 5> walls = {{{bone.get(), Limb::kBone},
                                                                 {muscle.get(), Limb::kBone},
                                                                 {muscle.get(), Limb::kMuscle},
                                                                 {fat.get(), Limb::kMuscle},
                                                                 {fat.get(), Limb::kBody}}};
  for (const auto& [field, radius] : walls) {
    const Offset offset = offsetOf(*field, limb, radius);
    std::printf("  wall at %4.1f mm: %+.3f mm in the mean, %.3f at most\n", radius, offset.mean,
                offset.worst);
    // Labels with voxels of 1 mm only say between which centers a wall is: it is within a third of
    // a voxel, with a mean error near zero.
    EXPECT_LT(std::abs(offset.mean), 0.05);
    EXPECT_LT(offset.worst, 0.35);
  }
  const auto cylinder = [](double r) { return std::numbers::pi * r * r * 2.0 * Limb::kHalf; };
  // Rims are rounded off by some tenths of a voxel, which is some tenths of a percent of these
  // volumes.
  EXPECT_NEAR(volumeOf(*bone) / cylinder(Limb::kBone), 1.0, 0.01);
  EXPECT_NEAR(volumeOf(*muscle) / (cylinder(Limb::kMuscle) - cylinder(Limb::kBone)), 1.0, 0.01);
  EXPECT_NEAR(volumeOf(*fat) / (cylinder(Limb::kBody) - cylinder(Limb::kMuscle)), 1.0, 0.01);
}

TEST(MadeLimb, WallsOfItsSlicesAreItsCylinders) {
  const TempFolder folder;
  const Limb limb;
  const Image image = readImage(
      test::writeDicom(limb.scan(test::obliqueAxes(Vec3(1, 1.1, 1.4))), folder, "series"));
  const double bone = 0.5 * (Limb::kBoneHu + Limb::kMuscleHu);
  const double skin = 0.5 * (Limb::kFatHu + Limb::kAirHu);
  for (const auto& [above, radius] : {std::pair(bone, Limb::kBone), std::pair(skin, Limb::kBody)}) {
    const Offset offset =
        offsetOf(*gridField(surfaceFromThreshold(image, {.above = above}, {})), limb, radius);
    std::printf("  wall at %4.1f mm: %+.3f mm in the mean, %.3f at most\n", radius, offset.mean,
                offset.worst);
    // Gray values say where between two voxels a wall is: to a fiftieth of the smallest voxel.
    EXPECT_LT(std::abs(offset.mean), 0.005);
    EXPECT_LT(offset.worst, 0.02);
  }
}

}  // namespace
}  // namespace palpate::vdb
