// Which voxels of a mask are held apart from the surface, as they are in a thin part.

#include "scan/thin_parts.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace palpate::vdb {
namespace {

/// A box of 20^3 voxels, those inside for which that is true.
Mask maskWhere(const std::function<bool(const std::array<int, 3>&)>& inside) {
  Mask mask;
  mask.box = {20, 20, 20};
  mask.inside.assign(std::size_t{22} * 22 * 22, 0);
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 20; ++i) {
        mask.inside[static_cast<std::size_t>(mask.at(i, j, k))] = inside({i, j, k}) ? 1 : 0;
      }
    }
  }
  return mask;
}

TEST(ThinParts, OneVoxelBetweenWallsOfTwoIsThinOnEitherSide) {
  // Two voxels thick, a step up of one voxel, and there a single one.
  const auto wall = [](const std::array<int, 3>& at) {
    const int low = at[0] < 10 ? 8 : 9;
    const int high = at[0] <= 10 ? 9 : 10;
    return at[2] >= low && at[2] <= high;
  };
  for (const bool is_gap : {false, true}) {
    const Mask mask = maskWhere([&](const std::array<int, 3>& at) { return wall(at) != is_gap; });
    for (int y = 4; y < 16; ++y) {
      EXPECT_TRUE(isAtThinPart(mask, {10, y, 9}));
      // Held off both ways.
      EXPECT_TRUE(isAtThinPart(mask, {10, y, 8}));
      EXPECT_TRUE(isAtThinPart(mask, {10, y, 10}));
      EXPECT_FALSE(isAtThinPart(mask, {5, y, 9}));
      EXPECT_FALSE(isAtThinPart(mask, {15, y, 9}));
    }
  }
}

TEST(ThinParts, ALoneVoxelOnABodyAndAPitInItAreNot) {
  const Mask mask = maskWhere([](const std::array<int, 3>& at) {
    const bool is_lone = at == std::array{5, 5, 10};
    const bool is_pit = at == std::array{14, 14, 9};
    return (at[2] < 10 || is_lone) && !is_pit;
  });
  for (const auto& at : {std::array{5, 5, 10}, {5, 5, 9}, {4, 5, 10}, {14, 14, 9}, {13, 14, 9}}) {
    EXPECT_FALSE(isAtThinPart(mask, at)) << at[0] << " " << at[1] << " " << at[2];
  }
}

TEST(ThinParts, NoVoxelOfABallIs) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(9, 10);
  std::uniform_real_distribution<double> radius(2.5, 8);
  for (int n = 0; n < 40; ++n) {
    const double r = radius(random);
    const std::array<double, 3> c = {shift(random), shift(random), shift(random)};
    const Mask mask = maskWhere([&](const std::array<int, 3>& at) {
      double square = 0.0;
      for (std::size_t a = 0; a < 3; ++a) square += (at[a] - c[a]) * (at[a] - c[a]);
      return square < r * r;
    });
    int thin = 0;
    for (int i = 0; i < 8000; ++i) {
      thin += isAtThinPart(mask, {i % 20, i / 20 % 20, i / 400}) ? 1 : 0;
    }
    EXPECT_EQ(thin, 0) << r << ": " << c[0] << " " << c[1] << " " << c[2];
  }
}

}  // namespace
}  // namespace palpate::vdb
