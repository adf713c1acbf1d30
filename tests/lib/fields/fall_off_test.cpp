// How steep a sum of metaballs can be: the bound is never less than the slope anywhere, and not
// much more.

#include "fields/fall_off.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// The derivative of one fall-off by q, from its formula.
double slopeOf(FallOff kind, double q) {
  if (kind == FallOff::kWyvill) return q < 1.0 ? 6.0 * q * std::pow(1.0 - q * q, 2.0) : 0.0;
  if (kind == FallOff::kGaussian) return 2.0 * q * std::exp(-q * q);
  return 2.0 * q / std::pow(1.0 + q * q, 2.0);
}

/// The sum of all slopes at a place, as if they all pointed in the same direction.
double slopesAt(const std::vector<Metaball>& balls, FallOff kind, const Vec3& p) {
  double sum = 0.0;
  for (const Metaball& ball : balls) {
    const double q = glm::length(p - ball.center) / ball.radius;
    sum += std::fabs(ball.strength) / ball.radius * slopeOf(kind, q);
  }
  return sum;
}

TEST(FallOff, TheSteepestSumIsFoundToATwentieth) {
  // Far from the origin, and of unequal sizes: only distances to the balls may count.
  const std::vector<Metaball> beside{{Vec3(0.30, -0.20, 0.11), 0.03, 1.0},
                                     {Vec3(0.33, -0.19, 0.10), 0.02, 0.8},
                                     {Vec3(0.31, -0.17, 0.12), 0.04, -0.5}};
  // Both have the same center; each is steepest where the other is flat.
  const std::vector<Metaball> within{{Vec3(0.30, -0.20, 0.11), 0.03, 3.0},
                                     {Vec3(0.30, -0.20, 0.11), 0.01, 1.0}};
  for (const auto& balls : {beside, within}) {
    for (const FallOff kind : {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare}) {
      double found = 0.0;
      constexpr int kSteps = 50;
      const Box3 box{Vec3(0.27, -0.23, 0.08), Vec3(0.35, -0.13, 0.16)};
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          for (int k = 0; k <= kSteps; ++k) {
            const Vec3 p = box.lo + Vec3(i, j, k) / double{kSteps} * box.size();
            found = std::max(found, slopesAt(balls, kind, p));
          }
        }
      }
      const double told = fields::steepestSum(balls, kind);
      EXPECT_GE(told, found);
      // The tolerance of a twentieth, plus what steps of a fifth of the smallest radius miss.
      EXPECT_LE(told, 1.05 * 1.03 * found);
    }
  }
}

TEST(FallOff, BetweenTwoDistancesTheSteepestIsNoneOther) {
  for (const FallOff kind : {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare}) {
    for (const double lo : {0.0, 0.2, 0.5, 0.8}) {
      for (const double hi : {lo, lo + 0.1, lo + 0.6}) {
        double most = 0.0;
        for (int i = 0; i <= 10000; ++i) {
          most = std::max(most, slopeOf(kind, lo + (hi - lo) * i / 10000.0));
        }
        EXPECT_NEAR(fields::steepest(kind, lo, hi), most, 1e-7) << lo << " " << hi;
      }
    }
  }
}

TEST(FallOff, ReachesItsValue) {
  for (const double value : {0.01, 0.3, 0.9}) {
    const double wyvill = fields::reachOf(FallOff::kWyvill, value);
    EXPECT_NEAR(std::pow(1.0 - wyvill * wyvill, 3.0), value, 1e-14);
    const double gaussian = fields::reachOf(FallOff::kGaussian, value);
    EXPECT_NEAR(std::exp(-gaussian * gaussian), value, 1e-14);
    const double inverse = fields::reachOf(FallOff::kInverseSquare, value);
    EXPECT_NEAR(1.0 / (1.0 + inverse * inverse), value, 1e-14);
  }
}

}  // namespace
}  // namespace palpate::test
