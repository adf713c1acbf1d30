// Boxes of an image's labels: all of them in one pass equal each by itself.

#include "voxel_box.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <set>

#include "palpate/core/error.h"
#include "scene_image.h"
#include "support/error_of.h"
#include "support/field_contract.h"
#include "support/temp_file.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

/// Specks of a few labels in an oblique, sheared image; some voxels are NaN.
Image randomImage(palpate::test::Random& random) {
  Image image;
  image.size = {7, 5, 6};
  image.origin = Vec3(0.01, -0.02, 0.03);
  for (int axis = 0; axis < 3; ++axis) image.axes[axis] = 1e-3 * random.direction();
  image.values.resize(7 * 5 * 6);
  for (float& voxel : image.values) {
    const double any = random.uniform(0.0, 1.0);
    voxel = any < 0.7    ? 0.0F
            : any < 0.75 ? std::numeric_limits<float>::quiet_NaN()
                         : static_cast<float>(std::floor(random.uniform(1.0, 5.0)));
  }
  return image;
}

TEST(VoxelBox, OneWalkFindsTheBoxOfEachValue) {
  palpate::test::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Image image = randomImage(random);
    const std::map<float, Box3> boxes = boxesOfValues(image);
    std::set<float> values;
    for (const float voxel : image.values) {
      if (!std::isnan(voxel)) values.insert(voxel);
    }
    ASSERT_EQ(boxes.size(), values.size());
    for (const float value : values) {
      const Box3 alone = boxWhere(image, [&](float voxel) { return voxel == value; });
      const Box3 box = boxes.at(value).grownBy(1.5 * longestStep(image));
      EXPECT_EQ(box.lo, alone.lo) << value;
      EXPECT_EQ(box.hi, alone.hi) << value;
    }
  }
}

TEST(VoxelBox, AWalkStopsWhenItIsAskedTo) {
  palpate::test::Random random(4);
  const Image image = randomImage(random);
  const std::atomic<bool> stop{true};
  watchStopFlag(&stop);
  const Error of_all = errorOf([&] { (void)boxesOfValues(image); });
  const Error of_one = errorOf([&] { (void)boxWhere(image, [](float) { return true; }); });
  watchStopFlag(nullptr);
  EXPECT_EQ(of_all.kind(), ErrorKind::kCancelled);
  EXPECT_EQ(of_one.kind(), ErrorKind::kCancelled);
}

TEST(VoxelBox, ALayerOfSeveralLabelsHasTheBoxOfAll) {
  const palpate::testing::TempFolder folder;
  test::NiftiFile file;
  const test::Bytes bytes = bytesOf(file);
  const std::string path = folder.file("labels.nii", std::string(bytes.begin(), bytes.end()));
  ImageFile image(path, ImageOptions{}, std::make_shared<Notes>(nullptr));
  std::set<int> present;
  for (const float voxel : image.image().values) present.insert(static_cast<int>(voxel));
  const std::vector<int> labels(present.begin(), present.end());
  ASSERT_GE(labels.size(), 2U);
  const auto expected = [&](const std::vector<int>& of) {
    return boxWhere(image.image(), [&](float voxel) {
      return std::find(of.begin(), of.end(), static_cast<int>(voxel)) != of.end();
    });
  };
  for (const std::vector<int>& of : {labels, {labels.front()}, {labels.back(), 30'000}}) {
    EXPECT_EQ(image.boxOfLabels(of).lo, expected(of).lo);
    EXPECT_EQ(image.boxOfLabels(of).hi, expected(of).hi);
  }
  EXPECT_TRUE(image.boxOfLabels({30'000}).isEmpty());
}

}  // namespace
}  // namespace palpate::vdb
