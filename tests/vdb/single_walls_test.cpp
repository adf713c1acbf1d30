// Places where a wall of a mask is a single voxel.

#include "scan/single_walls.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace palpate::vdb {
namespace {

constexpr int kSide = 20;

Mask maskWhere(const std::function<bool(const std::array<int, 3>&)>& inside) {
  Mask mask;
  mask.box = {kSide, kSide, kSide};
  mask.inside.assign(static_cast<std::size_t>(kSide + 2) * (kSide + 2) * (kSide + 2), 0);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      for (int k = 0; k < kSide; ++k) {
        mask.inside[static_cast<std::size_t>(mask.at(i, j, k))] = inside({i, j, k}) ? 1 : 0;
      }
    }
  }
  return mask;
}

bool isAny(const Mask& mask, const std::array<int, 3>& at) {
  return isSingleWall(mask, at, 0) || isSingleWall(mask, at, 1) || isSingleWall(mask, at, 2);
}

TEST(SingleWalls, OneVoxelBetweenPlacesOfTwoIsOneAndSoIsAGap) {
  // A wall two voxels thick with a step of one voxel, and beside it a single layer.
  const auto wall = [](const std::array<int, 3>& at) {
    const int low = at[0] < 10 ? 8 : 9;
    const int high = at[0] <= 10 ? 9 : 10;
    return at[2] >= low && at[2] <= high;
  };
  for (const bool is_gap : {false, true}) {
    const Mask mask = maskWhere([&](const std::array<int, 3>& at) { return wall(at) != is_gap; });
    for (int y = 4; y < 16; ++y) {
      EXPECT_TRUE(isSingleWall(mask, {10, y, 9}, 2)) << is_gap;
      for (const int x : {5, 9, 11, 15}) EXPECT_FALSE(isAny(mask, {x, y, 9})) << x;
    }
  }
}

TEST(SingleWalls, ALoneVoxelOnABodyAndAPitInItAreNone) {
  const Mask mask = maskWhere([](const std::array<int, 3>& at) {
    const bool is_lone = at == std::array{5, 5, 10};
    const bool is_pit = at == std::array{14, 14, 9};
    return (at[2] < 10 || is_lone) && !is_pit;
  });
  for (const auto& at : {std::array{5, 5, 10}, {5, 5, 9}, {4, 5, 10}, {14, 14, 9}, {13, 14, 9}}) {
    EXPECT_FALSE(isAny(mask, at)) << at[0] << " " << at[1] << " " << at[2];
  }
}

TEST(SingleWalls, WhatHasAnEdgeOpenBesideItPartsNothing) {
  // A sheet one voxel thick with one voxel moved up: around that voxel, the outside is connected by
  // edges, the inside is not.
  const auto sheet = [](const std::array<int, 3>& at) {
    const bool is_moved = at[0] == 10 && at[1] == 10;
    return at[2] == (is_moved ? 10 : 9);
  };
  const Mask wall = maskWhere(sheet);
  EXPECT_FALSE(isSingleWall(wall, {9, 10, 9}, 2));
  EXPECT_TRUE(isSingleWall(wall, {5, 5, 9}, 2));
  const Mask gap = maskWhere([&](const std::array<int, 3>& at) { return !sheet(at); });
  EXPECT_TRUE(isSingleWall(gap, {9, 10, 9}, 2));
}

TEST(SingleWalls, NoVoxelOfABallIsOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int ball = 0; ball < 20; ++ball) {
    const double c[3] = {9.0 + any(random), 9.0 + any(random), 9.0 + any(random)};
    const double r = 1.5 + 6.0 * any(random);
    const Mask mask = maskWhere([&](const std::array<int, 3>& at) {
      double sum = 0.0;
      for (std::size_t a = 0; a < 3; ++a) sum += (at[a] - c[a]) * (at[a] - c[a]);
      return sum < r * r;
    });
    int single = 0;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      single += isAny(mask, {i % 20, i / 20 % 20, i / 400}) ? 1 : 0;
    }
    EXPECT_EQ(single, 0) << r << ": " << c[0] << " " << c[1] << " " << c[2];
  }
}

}  // namespace
}  // namespace palpate::vdb
