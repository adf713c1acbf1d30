// The inner loops that smooth masks: compared with the derivative of the energy, and one
// instruction set with the other.
#include "scan/relax.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace palpate::vdb {
namespace {

using Values = std::array<float, 512>;
const RelaxWeights kWeights = {{1.0F, 0.2F, 0.012F}, {0.5F, 2.0F, 0.7F}};

/// Random values, some of which do not count; the bit of row 8 x + y is set if one of its voxels
/// counts.
struct Made {
  Patch patch;
  std::uint64_t rows = 0;

  Made(unsigned seed, double missing) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-5.0F, 5.0F);
    std::bernoulli_distribution is_missing(missing);
    std::bernoulli_distribution is_row(missing > 0.0 ? 0.7 : 1.0);
    for (int x = -Patch::kHalo; x < 8 + Patch::kHalo; ++x) {
      for (int y = -Patch::kHalo; y < 8 + Patch::kHalo; ++y) {
        const bool has_voxels = is_row(random);
        for (int z = -Patch::kFirst; z < Patch::kRow - Patch::kFirst; ++z) {
          const bool none = !has_voxels || is_missing(random);
          patch.values[Patch::at(x, y, z)] =
              none ? std::numeric_limits<float>::quiet_NaN() : value(random);
        }
        const bool in_block = x >= 0 && x < 8 && y >= 0 && y < 8;
        if (in_block && has_voxels) rows |= std::uint64_t{1} << (8 * x + y);
      }
    }
  }
};

/// Half the derivative of the weighted sum of squares by one voxel, computed square by square.
double forceAt(const Patch& patch, int x, int y, int z) {
  const std::array<int, 3> at = {x, y, z};
  const auto value = [&](const std::array<int, 3>& p) {
    return static_cast<double>(patch.values[Patch::at(p[0], p[1], p[2])]);
  };
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (int shift = -1; shift <= 1; ++shift) {
      std::array<int, 3> low = at, middle = at, high = at;
      middle[a] += shift;
      low[a] = middle[a] - 1;
      high[a] = middle[a] + 1;
      const double bend = value(low) - 2.0 * value(middle) + value(high);
      const double part = shift == 0 ? -2.0 : 1.0;
      if (!std::isnan(bend)) sum += static_cast<double>(kWeights.axis[a]) * part * bend;
    }
    const std::size_t u = (a + 1) % 3, v = (a + 2) % 3;
    for (const int du : {-1, 0}) {
      for (const int dv : {-1, 0}) {
        std::array<int, 3> first = at;
        first[u] += du;
        first[v] += dv;
        std::array<int, 3> by_u = first, by_v = first, by_both = first;
        ++by_u[u];
        ++by_v[v];
        ++by_both[u];
        ++by_both[v];
        const double twist = value(first) - value(by_u) - value(by_v) + value(by_both);
        const double part = du == dv ? 1.0 : -1.0;
        if (!std::isnan(twist)) sum += static_cast<double>(kWeights.plane[a]) * part * twist;
      }
    }
  }
  return sum;
}

TEST(RelaxKernels, TheForceIsTheDerivativeOfTheEnergy) {
  for (const double missing : {0.0, 0.02, 0.3}) {
    const Made made(3, missing);
    alignas(32) Values force{};
    relaxKernels().force(made.patch, made.rows, kWeights, force.data());
    int seen = 0;
    for (int n = 0; n < 512; ++n) {
      const int x = n >> 6, y = n >> 3 & 7, z = n & 7;
      const auto place = static_cast<std::size_t>(n);
      if ((made.rows >> (n >> 3) & 1U) == 0) {
        EXPECT_EQ(force[place], 0.0F);  // unchanged
        continue;
      }
      if (std::isnan(made.patch.values[Patch::at(x, y, z)])) continue;
      ++seen;
      // Some fifty sums of floats below 100.
      EXPECT_NEAR(static_cast<double>(force[place]), forceAt(made.patch, x, y, z), 1e-3);
    }
    EXPECT_GT(seen, 200);
  }
}

// The variant for this processor, compared with the plain one.
TEST(RelaxKernels, AllKindsGiveTheSameBits) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> value(-1.0F, 1.0F);
  alignas(32) Values bias{}, share{}, lower{}, upper{}, before{};
  for (std::size_t n = 0; n < 512; ++n) {
    bias[n] = value(random);
    share[n] = 0.02F + 0.01F * value(random);
    lower[n] = -3.0F + value(random);
    upper[n] = 3.0F + value(random);
    before[n] = value(random);
  }
  for (const double missing : {0.0, 0.02, 0.3}) {
    const Made made(5, missing);
    alignas(32) std::array<std::array<Values, 4>, 2> results{};
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const RelaxKernels& kernels = kind == 0 ? kBaseRelaxKernels : relaxKernels();
      auto& [force, ahead, after, spread] = results[kind];
      kernels.force(made.patch, made.rows, kWeights, force.data());
      after = before;
      kernels.relax(made.patch, made.rows, kWeights,
                    {bias.data(), share.data(), lower.data(), upper.data(), after.data(),
                     ahead.data(), 0.7F});
      const float shares[3] = {0.15F, 0.1F, 0.02F};
      kernels.diffuse(made.patch, made.rows, 2, shares, spread.data());
    }
    EXPECT_EQ(std::memcmp(&results[0], &results[1], sizeof results[0]), 0) << missing;
  }
}

}  // namespace
}  // namespace palpate::vdb
