// The survey of label images, compared with brute force on random images, and with shapes of known
// area.
#include "palpate/vdb/label_survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "scan/mask.h"
#include "support/error_of.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

Image imageOf(std::array<int, 3> size, const Vec3& spacing,
              const std::function<int(int, int, int)>& label) {
  Image image;
  image.source = "labels.nii";
  image.size = size;
  image.axes = Mat3(Vec3(spacing.x, 0, 0), Vec3(0, spacing.y, 0), Vec3(0, 0, spacing.z));
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        image.values.push_back(static_cast<float>(label(i, j, k)));
      }
    }
  }
  return image;
}

/// A random label for each voxel, more often than not the same as its neighbor's.
Image randomImage(unsigned seed, int labels) {
  std::mt19937 random(seed);
  std::vector<int> drawn;
  const std::array<int, 3> size = {9, 7, 6};
  return imageOf(size, Vec3(1, 2, 3) * kMm, [&](int i, int, int) {
    const bool copies = i > 0 && random() % 2 == 0;
    drawn.push_back(copies ? drawn.back()
                           : static_cast<int>(random() % static_cast<unsigned>(labels)));
    return drawn.back();
  });
}

/// Pieces found by flood fill from every voxel: their labels and sizes, sorted.
std::vector<std::pair<int, std::uint64_t>> floodedPieces(const Image& image, int open_label) {
  const int nx = image.size[0];
  const int ny = image.size[1];
  const int nz = image.size[2];
  std::vector<bool> seen(image.values.size(), false);
  std::vector<std::pair<int, std::uint64_t>> pieces;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto at = [&](int x, int y, int z) {
          return static_cast<std::size_t>(x + nx * (y + ny * z));
        };
        if (seen[at(i, j, k)]) continue;
        const float label = image.at(i, j, k);
        std::uint64_t count = 0;
        std::vector<std::array<int, 3>> stack = {{i, j, k}};
        seen[at(i, j, k)] = true;
        while (!stack.empty()) {
          const auto [x, y, z] = stack.back();
          stack.pop_back();
          ++count;
          for (int n = 0; n < 27; ++n) {
            const int dx = n % 3 - 1;
            const int dy = n / 3 % 3 - 1;
            const int dz = n / 9 - 1;
            const int steps = std::abs(dx) + std::abs(dy) + std::abs(dz);
            const bool is_open = static_cast<int>(label) == open_label;
            if (steps == 0 || steps > (is_open ? 2 : 1)) continue;
            const int a = x + dx;
            const int b = y + dy;
            const int c = z + dz;
            if (a < 0 || b < 0 || c < 0 || a >= nx || b >= ny || c >= nz) continue;
            if (seen[at(a, b, c)] || image.at(a, b, c) != label) continue;
            seen[at(a, b, c)] = true;
            stack.push_back({a, b, c});
          }
        }
        pieces.emplace_back(static_cast<int>(label), count);
      }
    }
  }
  std::sort(pieces.begin(), pieces.end());
  return pieces;
}

TEST(LabelSurvey, PiecesOfRandomImagesAreThoseOfAFlood) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Image image = randomImage(seed, 3);
    const LabelSurvey survey = surveyLabels(image, {{1}, {2}}, nullptr);
    std::vector<std::pair<int, std::uint64_t>> pieces;
    for (std::size_t r = 0; r < survey.regions.size(); ++r) {
      const int label = r == survey.outside() ? 0 : static_cast<int>(r) + 1;
      std::uint64_t sum = 0;
      for (const auto& piece : survey.regions[r].pieces) {
        pieces.emplace_back(label, piece.voxels);
        sum += piece.voxels;
        // The place is one of the piece's voxels.
        const Vec3 index = glm::round(image.toIndex(piece.place));
        EXPECT_EQ(image.at(static_cast<int>(index.x), static_cast<int>(index.y),
                           static_cast<int>(index.z)),
                  static_cast<float>(label));
      }
      EXPECT_EQ(sum, survey.regions[r].voxels);
    }
    std::sort(pieces.begin(), pieces.end());
    ASSERT_EQ(pieces, floodedPieces(image, 0)) << "seed " << seed;
  }
}

TEST(LabelSurvey, ContactsOfRandomImagesAreTheirFacesCountedOneByOne) {
  const double area[3] = {6e-6, 3e-6, 2e-6};  // of the faces across x, y and z [m2]
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Image image = randomImage(seed, 4);
    const LabelSurvey survey = surveyLabels(image, {{1}, {2}, {3}}, nullptr);
    const auto region_at = [&](int i, int j, int k) -> std::size_t {
      const auto [nx, ny, nz] = image.size;
      if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return survey.outside();
      const int label = static_cast<int>(image.at(i, j, k));
      return label == 0 ? survey.outside() : static_cast<std::size_t>(label - 1);
    };
    std::map<std::pair<std::size_t, std::size_t>, double> between;
    for (int k = -1; k < image.size[2]; ++k) {
      for (int j = -1; j < image.size[1]; ++j) {
        for (int i = -1; i < image.size[0]; ++i) {
          const std::size_t here = region_at(i, j, k);
          for (int axis = 0; axis < 3; ++axis) {
            const std::size_t next = region_at(i + (axis == 0 ? 1 : 0), j + (axis == 1 ? 1 : 0),
                                               k + (axis == 2 ? 1 : 0));
            if (here == next) continue;
            between[{here, next}] += area[axis] * 2.0 / 3.0;
            between[{next, here}] += area[axis] * 2.0 / 3.0;
          }
        }
      }
    }
    std::size_t pairs = 0;
    for (std::size_t r = 0; r < survey.regions.size(); ++r) {
      for (const auto& contact : survey.regions[r].contacts) {
        ++pairs;
        EXPECT_NEAR(contact.area, (between[{r, contact.other}]), 1e-15) << "seed " << seed;
      }
    }
    EXPECT_EQ(pairs, between.size());
  }
}

TEST(LabelSurvey, WhatEncloses) {
  // Nested balls about the middle: body 18, muscle 14, a shell of bone 9, core 6; and a nerve of 3
  // voxels that leads from outside into the muscle.
  const Image image = imageOf({41, 41, 41}, Vec3(kMm), [](int i, int j, int k) {
    const double r = std::hypot(i - 20, j - 20, k - 20);
    if (j == 20 && k == 20 && i < 9) return 4;
    return r < 6 ? 3 : r < 9 ? 2 : r < 14 ? 1 : 0;
  });
  const VoxelMask body = [&] {
    const Image ball = imageOf({41, 41, 41}, Vec3(kMm), [](int i, int j, int k) {
      return std::hypot(i - 20, j - 20, k - 20) < 18 ? 1 : 0;
    });
    return labelMask(ball, image);
  }();
  const LabelSurvey survey = surveyLabels(image, {{1}, {2}, {3}, {4}}, &body);
  ASSERT_EQ(survey.gap(), 4U);
  EXPECT_FALSE(survey.regions[survey.gap()].within.has_value());
  EXPECT_FALSE(survey.regions[0].within.has_value());  // the nerve is another way to it
  EXPECT_EQ(survey.regions[1].within, 0U);
  EXPECT_EQ(survey.regions[2].within, 1U);
  EXPECT_FALSE(survey.regions[3].within.has_value());
  // The core touches only its shell.
  ASSERT_EQ(survey.regions[2].contacts.size(), 1U);
  EXPECT_EQ(survey.regions[2].contacts[0].other, 1U);
  EXPECT_TRUE(survey.regions[3].at_border);
  EXPECT_FALSE(survey.regions[0].at_border);

  // Without the nerve everything is within the gap.
  const LabelSurvey without = surveyLabels(image, {{1}, {2}, {3}}, &body);
  EXPECT_EQ(without.regions[0].within, without.gap());
}

TEST(LabelSurvey, WhatTheBorderCutsIsNotOpenThere) {
  // A rod in a tube; both reach from end to end of the image.
  const auto rod = [](double rest) {
    return imageOf({21, 21, 9}, Vec3(kMm), [rest](int i, int j, int) {
      const double r = std::hypot(i - 10, j - 10);
      return r < 3 ? 2 : r < 6 ? 1 : static_cast<int>(rest);
    });
  };
  const LabelSurvey survey = surveyLabels(rod(0), {{1}, {2}}, nullptr);
  EXPECT_FALSE(survey.regions[0].within.has_value());
  EXPECT_EQ(survey.regions[1].within, 0U);
  EXPECT_GT(survey.regions[1].border, 0.0);
  // If all voxels have a label, only the image's border is outside.
  const LabelSurvey full = surveyLabels(rod(3), {{1}, {2}, {3}}, nullptr);
  for (const auto& region : full.regions) EXPECT_FALSE(region.within.has_value());
}

TEST(LabelSurvey, AreaAndVolumeOfABallInLongVoxels) {
  constexpr double kRadius = 20.3 * kMm;
  const Vec3 spacing = Vec3(1.0, 1.0, 3.0) * kMm;
  const Image image = imageOf({51, 51, 17}, spacing, [&](int i, int j, int k) {
    const Vec3 p = Vec3(i - 25, j - 25, k - 8) * spacing;
    return glm::length(p) < kRadius ? 7 : 0;
  });
  const LabelSurvey survey = surveyLabels(image, {{7}}, nullptr);
  const double area = 4.0 * std::numbers::pi * kRadius * kRadius;
  // All directions occur, so that faces average to 3/2 of the area; slices of 3 mm cause an error
  // of some percent.
  EXPECT_NEAR(survey.regions[0].area, area, 0.03 * area);
  EXPECT_NEAR(survey.regions[0].volume, area * kRadius / 3.0, 0.02 * area * kRadius / 3.0);
  EXPECT_NEAR(survey.regions[0].bounds.size().x, 40.0 * kMm, 1e-12);
}

TEST(LabelSurvey, IslandsAndCavities) {
  // A block of label 1 with a cavity of two voxels that meet at an edge, in it an island of label 2
  // (whose largest piece is elsewhere), and a separate speck of label 1.
  const auto label = [](int i, int j, int k) {
    if ((i == 4 && j == 4 && k == 4) || (i == 5 && j == 5 && k == 4)) return 0;
    if (i == 6 && j == 6 && k == 6) return 2;
    if (i >= 2 && i < 9 && j >= 2 && j < 9 && k >= 2 && k < 9) return 1;
    if (i >= 12 && j >= 12 && k >= 12) return 2;
    return i == 2 && j == 12 && k == 12 ? 1 : 0;
  };
  const std::vector<std::vector<int>> regions = {{1}, {2}};
  const Image before = imageOf({16, 16, 16}, Vec3(kMm), label);
  const LabelSurvey survey = surveyLabels(before, regions, nullptr);
  ASSERT_EQ(survey.regions[survey.outside()].pieces.size(), 2U);
  EXPECT_EQ(survey.regions[survey.outside()].pieces[1].voxels, 2U);
  EXPECT_EQ(survey.regions[survey.outside()].pieces[1].around, 0U);
  ASSERT_EQ(survey.regions[0].pieces.size(), 2U);

  Image merged = before;
  const auto changes = changeIslands(merged, regions, survey, 3, IslandRule::kMerge);
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[0].from, survey.outside());
  EXPECT_EQ(changes[0].voxels, 2U);
  EXPECT_EQ(merged.at(4, 4, 4), 1.0F);
  EXPECT_EQ(merged.at(5, 5, 4), 1.0F);
  EXPECT_EQ(merged.at(6, 6, 6), 1.0F);
  EXPECT_EQ(merged.at(2, 12, 12), 0.0F);  // its surroundings are air
  const LabelSurvey after = surveyLabels(merged, regions, nullptr);
  for (const auto& region : after.regions) EXPECT_LE(region.pieces.size(), 1U);

  Image dropped = before;
  EXPECT_EQ(changeIslands(dropped, regions, survey, 3, IslandRule::kDrop).size(), 2U);
  EXPECT_EQ(dropped.at(4, 4, 4), 0.0F);
  EXPECT_EQ(dropped.at(6, 6, 6), 0.0F);
  EXPECT_EQ(dropped.at(2, 12, 12), 0.0F);

  Image kept = before;
  EXPECT_TRUE(changeIslands(kept, regions, survey, 1, IslandRule::kMerge).empty());
  EXPECT_EQ(kept.values, before.values);
}

TEST(LabelSurvey, TheBodyIsTheOneThatScenesMakeOfAThreshold) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    Image image = randomImage(seed, 8);
    const VoxelMask body = bodyMask(image, 3.0, image);
    Mask mask = maskOf(
        image, [](float value) { return value > 3.0F; }, 2);
    keepLargestPiece(mask);
    fillCavities(mask);
    std::size_t n = 0;
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i, ++n) {
          const int at[3] = {i - mask.first[0], j - mask.first[1], k - mask.first[2]};
          const bool is_in_box = at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < mask.box[0] &&
                                 at[1] < mask.box[1] && at[2] < mask.box[2];
          const bool inside =
              is_in_box && mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] != 0;
          ASSERT_EQ(body[n] != 0, inside) << "seed " << seed << " voxel " << n;
        }
      }
    }
  }
}

TEST(LabelSurvey, ABodyOnOtherVoxelsIsTakenFromTheNearest) {
  const Image coarse = imageOf({4, 4, 4}, Vec3(4.0 * kMm), [](int i, int j, int k) {
    return i == 1 && j == 2 && k == 1 ? 9 : 0;
  });
  Image fine = imageOf({8, 8, 8}, Vec3(2.0 * kMm), [](int, int, int) { return 0; });
  fine.origin = Vec3(-1.0 * kMm);  // centers at -1, 1, 3, ...: two in each coarse voxel
  const VoxelMask body = labelMask(coarse, fine);
  for (int k = 0; k < 8; ++k) {
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 8; ++i) {
        const bool is_in = i / 2 == 1 && j / 2 == 2 && k / 2 == 1;
        EXPECT_EQ(body[static_cast<std::size_t>(i + 8 * (j + 8 * k))] != 0, is_in);
      }
    }
  }
}

TEST(LabelSurvey, CountsAndWhatIsNoLabelImage) {
  const Image image = randomImage(1, 5);
  std::map<int, std::uint64_t> expected;
  for (const float value : image.values) ++expected[static_cast<int>(value)];
  EXPECT_EQ(countLabels(image), expected);

  for (const float wrong : {0.5F, -1.0F, 70000.0F, std::numeric_limits<float>::quiet_NaN()}) {
    Image bad = image;
    bad.values[9 * 7 + 3] = wrong;
    const Error error = errorOf([&] { (void)countLabels(bad); });
    EXPECT_EQ(error.problem().code, "labels.not_labels");
    EXPECT_NE(error.problem().message.find("voxel (3, 0, 1)"), std::string::npos)
        << error.problem().message;
    EXPECT_EQ(error.problem().file, "labels.nii");
  }
  // Values below 0, which are not labels, in many voxels from the first one on.
  Image below = image;
  std::fill(below.values.begin(), below.values.begin() + 60, -1.0F);
  EXPECT_EQ(errorOf([&] { (void)countLabels(below); }).problem().code, "labels.not_labels");
  // Gray values are integers too.
  std::mt19937 random(7);
  const Image gray = imageOf({20, 20, 20}, Vec3(kMm),
                             [&](int, int, int) { return static_cast<int>(random() % 256); });
  EXPECT_EQ(errorOf([&] { (void)countLabels(gray); }).problem().code, "labels.not_labels");
  EXPECT_EQ(errorOf([&] { (void)bodyMask(gray, 300.0, gray); }).problem().code, "scan.empty");
}

}  // namespace
}  // namespace palpate::vdb
