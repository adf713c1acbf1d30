// Voxel centers keep their labels in what is made of a label image.
#include "palpate/vdb/label_centers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "palpate/vdb/image.h"
#include "support/scan_folder.h"
#include "vdb/label_phantoms.h"

namespace palpate::vdb {
namespace {

TEST(LabelCenters, CountsWhatChangedAndWhatChangedAgainstItsNeighbors) {
  // Part 0 (labels 4 and 5) fills the half below z = 0; what is above is in no part.
  const Image image = test::labelImage(Vec3(1.0), Vec3(4.0), [](const Vec3& p) {
    if (p.z > 0.1) return 0;
    return p.x < 0.0 ? 4 : 5;
  });
  const std::map<int, int> part_of = {{4, 0}, {5, 0}};
  const auto truth = [&](const Vec3& p) { return p.z > 1e-4 ? kNoPart : 0; };
  const LabelCenters whole = countCenters(image, part_of, truth);
  EXPECT_EQ(whole.parts.at(0).centers, 9U * 9U * 5U);
  EXPECT_EQ(whole.parts.at(kNoPart).centers, 9U * 9U) << "only those beside the part";
  EXPECT_EQ(whole.all.changed, 0U);
  EXPECT_FALSE(whole.place.has_value());

  // On the face of a half-space 17 of 26 neighbors have the same part.
  const Vec3 lost(2e-3, 1e-3, 0.0);
  const LabelCenters hole = countCenters(image, part_of, [&](const Vec3& p) {
    return glm::length(p - lost) < 1e-6 ? kNoPart : truth(p);
  });
  EXPECT_EQ(hole.parts.at(0).changed, 1U);
  EXPECT_EQ(hole.parts.at(0).against, 1U);
  ASSERT_TRUE(hole.place.has_value());
  EXPECT_LT(glm::length(*hole.place - lost), 1e-6);

  // Centers in something else are not looked at.
  const LabelCenters covered = countCenters(image, part_of, [&](const Vec3& p) {
    return glm::length(p - lost) < 1e-6 ? kOtherPart : truth(p);
  });
  EXPECT_EQ(covered.all.changed, 0U);

  // A sheet one voxel thin has only 8 of 26 neighbors in it.
  const Image sheet = test::labelImage(Vec3(1.0), Vec3(4.0),
                                       [](const Vec3& p) { return std::abs(p.z) < 0.1 ? 4 : 0; });
  const LabelCenters none = countCenters(sheet, part_of, [](const Vec3&) { return kNoPart; });
  EXPECT_EQ(none.parts.at(0).changed, 81U);
  EXPECT_EQ(none.parts.at(0).against, 0U);
}

// Where the grid's voxels lie at those of the image, which side a center is on is stored.
TEST(LabelCenters, ABallsCentersAreAllOnTheirSide) {
  for (const Vec3& spacing : {Vec3(1.0), Vec3(0.5, 0.5, 2.0)}) {
    for (const Vec3& center : {Vec3(0.13, -0.29, 0.37), Vec3(-0.21, 0.08, 1.12)}) {
      const Image image = test::BallPhantom{center, 9.0}.image(spacing);
      EXPECT_EQ(test::LabelScene(image).centers().all.changed, 0U);
    }
  }
}

// Bounds from what a clinician accepts: none against its neighbors, 0.3 % of the others.
void expectKept(const CenterCount& all) {
  EXPECT_GT(all.centers, 50000U);
  EXPECT_EQ(all.against, 0U);
  EXPECT_LT(1000U * all.changed, 3U * all.centers);
}

void expectKept(const test::FoldedHead& head, const Vec3& spacing) {
  const Image image = head.image(spacing);
  const test::LabelScene scene(image);
  expectKept(scene.centers().all);
  EXPECT_EQ(test::openRays(scene, 4, head.radius, 0.05, 1000), 0) << "the dura has a hole";
}

TEST(LabelCenters, HardlyAnyChangesInFoldsAndLayersOneVoxelThin) { expectKept({}, Vec3(1.0)); }

// The folds are thinner than a slice: a lap over both sides of such a layer would cover its
// centers.
TEST(LabelCenters, NoneChangesAgainstItsNeighborsInFoldsOfThickSlices) {
  expectKept({.radius = 18.0, .ribbon = 1.75, .period = 11.0}, Vec3(0.5, 0.5, 2.0));
}

// Its centers lie between the voxels of its grids.
TEST(LabelCenters, NoneChangesAgainstItsNeighborsInAVertebra) {
  const std::string file = palpate::testing::scanPath("vertebra/subregions.nii.gz");
  PALPATE_NEEDS_SCAN(file);
  const Image image = readNifti(file);
  expectKept(test::LabelScene(image).centers().all);
}

// A degree is what a clinician accepts in slices 4 : 1.
TEST(LabelPhantoms, ABallInThickSlicesHasItsNormals) {
  for (const Vec3& center :
       {Vec3(0.13, -0.29, 0.37), Vec3(-0.21, 0.08, 1.12), Vec3(0.05, 0.22, -0.71)}) {
    const test::BallPhantom ball{center, 15.0};
    const Image image = ball.image(Vec3(0.5, 0.5, 2.0));
    const test::LabelScene scene(image);
    const test::SurfaceError error = test::surfaceError(*scene.field(1), ball.points());
    EXPECT_LT(error.normal, 1.0);
    EXPECT_LT(std::abs(error.bias), 0.05 * 0.5);
  }
}

// Bounds from what a clinician accepts: a twentieth of a voxel from three voxels on, edges rounded
// over at most a voxel.
TEST(LabelPhantoms, AFaceBetweenCliffsIsFlatUpToItsEdges) {
  const Vec3 spacing(1.0);
  for (const test::SlabPhantom& slab :
       {test::SlabPhantom{{24, 20, 8}}, test::SlabPhantom{{40, 30, 4}}}) {
    const Image image = slab.image(spacing);
    const test::LabelScene scene(image);
    const Field& field = *scene.field(1);
    EXPECT_LT(slab.error(field, spacing, 3.0, kInfinity), 0.05);
    EXPECT_LT(slab.cutOff(field, spacing), 1.0);
    EXPECT_EQ(scene.centers().all.changed, 0U);
  }
}

// The image's border bends no surface: a tilted plane is as flat beside it as anywhere else
// (LabelSurface.BallTorusAndTiltedPlaneAtOnce).
TEST(LabelPhantoms, AnInterfaceIsFlatUpToTheImagesBorder) {
  const Vec3 spacing(1.0);
  const test::PlanePhantom plane{Vec3(0.13, -0.29, 0.37), glm::normalize(Vec3(0.4, 0.3, 1))};
  const Image image = plane.image(spacing);
  const test::LabelScene scene(image);
  const test::SurfaceError error =
      test::surfaceError(*scene.field(1), plane.points(spacing), scene.field(2).get());
  EXPECT_LT(error.normal, 0.5);
  EXPECT_LT(error.most, 0.1);
}

TEST(LabelCenters, AnInterfacesCentersAreAllOnTheirSide) {
  for (const Vec3& spacing : {Vec3(1.0), Vec3(0.5, 0.5, 2.0)}) {
    const test::PlanePhantom plane{Vec3(0.13, -0.29, 0.37), glm::normalize(Vec3(0.12, 0.05, 1))};
    const Image image = plane.image(spacing);
    EXPECT_EQ(test::LabelScene(image).centers().all.changed, 0U);
  }
}

// Which number a label has says nothing.
TEST(LabelCenters, OtherNumbersMakeTheSameParts) {
  const Image image = test::randomLabels(3, {18, 16, 14}, Vec3(1.0, 0.8, 1.2), 4, 6.0);
  Image renamed = image;
  constexpr float kNames[] = {0.0F, 9.0F, 2.0F, 5.0F};
  for (float& value : renamed.values) value = kNames[static_cast<std::size_t>(value)];
  const test::LabelScene scene(image);
  const test::LabelScene other(renamed);
  int different = 0;
  constexpr int kPoints = 4000;
  for (int n = 0; n < kPoints; ++n) {
    const Vec3 p = Vec3(n % 17, n / 17 % 15, n / 255) * Vec3(1.0, 0.8, 1.2) + Vec3(0.31, 0.17, 0.4);
    const auto label = static_cast<std::size_t>(scene.labelAt(p));
    different += static_cast<float>(other.labelAt(p)) == kNames[label] ? 0 : 1;
  }
  // Layers come in the order of their numbers, which decides only where two fields are equal.
  EXPECT_LE(different, kPoints / 1000);
}

}  // namespace
}  // namespace palpate::vdb
