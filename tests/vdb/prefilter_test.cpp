// The contents of bricks, voxel by voxel, compared with the formula in prefilter.h.

#include "brick/prefilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "support/field_contract.h"

namespace palpate::vdb {
namespace {

using palpate::test::Random;

constexpr float kPlateau = 2.7F;
constexpr double kUnitsPerVoxel = 0.7;

/// Voxels by their coordinates in a brick: from -3 to 11.
class Voxels {
 public:
  explicit Voxels(Neighborhood& of) : of_(of) {}
  [[nodiscard]] float& value(int x, int y, int z) {
    return of_.values[static_cast<std::size_t>((x + 3) * Neighborhood::kSlab +
                                               (y + 3) * Neighborhood::kRow + z + 3)];
  }
  void setKnown(int x, int y, int z) { word(x, y) |= static_cast<std::uint16_t>(1U << (z + 3)); }
  [[nodiscard]] bool isKnown(int x, int y, int z) { return (word(x, y) >> (z + 3) & 1U) != 0; }

 private:
  [[nodiscard]] std::uint16_t& word(int x, int y) {
    return of_.known[static_cast<std::size_t>((x + 3) * Neighborhood::kSide + y + 3)];
  }
  Neighborhood& of_;
};

/// Values like those of a distance; all voxels are known except every `hole`-th one.
std::unique_ptr<Neighborhood> randomNeighborhood(Random& random, double hole) {
  auto made = std::make_unique<Neighborhood>();
  Voxels voxels(*made);
  for (int x = -3; x <= 11; ++x) {
    for (int y = -3; y <= 11; ++y) {
      for (int z = -3; z <= 11; ++z) {
        voxels.value(x, y, z) = static_cast<float>(random.uniform(-3.0, 3.0));
        if (random.uniform(0.0, 1.0) > hole) voxels.setKnown(x, y, z);
      }
    }
  }
  return made;
}

/// A voxel's coefficient, and whether it is known.
struct Coefficient {
  double value = 0.0;
  bool is_known = false;
};

class Reference {
 public:
  explicit Reference(Neighborhood& of) : voxels_(of) {}

  [[nodiscard]] Coefficient cubic(int x, int y, int z) {
    const float own = voxels_.value(x, y, z);
    const bool near = isKnownWithin(1, x, y, z);
    if (!near) {
      const bool known = voxels_.isKnown(x, y, z);
      return {known ? std::clamp(own, -kPlateau, kPlateau) : std::copysign(kPlateau, own), false};
    }
    double c = static_cast<double>(own) - sum(x, y, z) / 6.0;
    if (isKnownWithin(2, x, y, z)) {
      // The Laplacian of the Laplacian, and the fourth differences.
      const double twice = sum(x - 1, y, z) + sum(x + 1, y, z) + sum(x, y - 1, z) +
                           sum(x, y + 1, z) + sum(x, y, z - 1) + sum(x, y, z + 1) -
                           3.0 * (2.0 * sum(x, y, z));
      const double fourth =
          (-2.0 * second(0, x, y, z) + second(0, x - 1, y, z) + second(0, x + 1, y, z)) +
          (-2.0 * second(1, x, y, z) + second(1, x, y - 1, z) + second(1, x, y + 1, z)) +
          (-2.0 * second(2, x, y, z) + second(2, x, y, z - 1) + second(2, x, y, z + 1));
      c += twice / 72.0 + 11.0 / 720.0 * fourth;
    }
    return {c, true};
  }

  [[nodiscard]] Coefficient linear(int x, int y, int z) {
    const float own = voxels_.value(x, y, z);
    const bool known = voxels_.isKnown(x, y, z);
    return {known ? own : std::copysign(kPlateau, own), known};
  }

 private:
  /// Whether all voxels within that many steps along the axes are known.
  [[nodiscard]] bool isKnownWithin(int steps, int x, int y, int z) {
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        for (int k = -steps; k <= steps; ++k) {
          if (std::abs(i) + std::abs(j) + std::abs(k) > steps) continue;
          if (!voxels_.isKnown(x + i, y + j, z + k)) return false;
        }
      }
    }
    return true;
  }
  [[nodiscard]] double second(int axis, int x, int y, int z) {
    const int i = axis == 0 ? 1 : 0, j = axis == 1 ? 1 : 0, k = axis == 2 ? 1 : 0;
    return static_cast<double>(voxels_.value(x - i, y - j, z - k)) +
           static_cast<double>(voxels_.value(x + i, y + j, z + k)) -
           2.0 * static_cast<double>(voxels_.value(x, y, z));
  }
  [[nodiscard]] double sum(int x, int y, int z) {
    return second(0, x, y, z) + second(1, x, y, z) + second(2, x, y, z);
  }
  Voxels voxels_;
};

template <class Of>
void expectIs(const Brick& brick, int first, int last, const Of& of) {
  for (int x = -1; x <= 9; ++x) {
    for (int y = -1; y <= 9; ++y) {
      for (int z = -1; z <= 9; ++z) {
        const auto expected = static_cast<float>(of(x, y, z).value * (1.0 / kUnitsPerVoxel));
        ASSERT_EQ(brick.values[Brick::at(x, y, z)], expected) << x << " " << y << " " << z;
      }
    }
  }
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 8; ++z) {
        bool all = true;
        for (int n = 0; n < 64; ++n) {
          const int i = first + n / 16, j = first + n / 4 % 4, k = first + n % 4;
          if (std::max({i, j, k}) > last) continue;
          all = all && of(x + i, y + j, z + k).is_known;
        }
        ASSERT_EQ((brick.known[x * 8 + y] >> z & 1) != 0, all) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(Prefilter, IsItsFormulaToTheLastBit) {
  Random random(5);
  for (const double hole : {0.0, 0.001, 0.02, 0.3, 1.0}) {
    const auto from = randomNeighborhood(random, hole);
    Reference reference(*from);
    const auto brick = std::make_unique<Brick>();
    fillCubic(*from, kPlateau, kUnitsPerVoxel, *brick);
    expectIs(*brick, -1, 2, [&](int x, int y, int z) { return reference.cubic(x, y, z); });
    fillLinear(*from, kPlateau, kUnitsPerVoxel, *brick);
    expectIs(*brick, 0, 1, [&](int x, int y, int z) { return reference.linear(x, y, z); });
  }
}

}  // namespace
}  // namespace palpate::vdb
