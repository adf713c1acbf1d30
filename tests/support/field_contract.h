#pragma once
/// The contract of palpate::Field as checks that can be applied to any field.
///
/// A test file adds its fields with
///   INSTANTIATE_TEST_SUITE_P(Spheres, FieldContract, ::testing::ValuesIn(cases()),
///                            ::testing::PrintToStringParamName());
/// and each check can also be called by itself, to show that it catches a field that violates the
/// contract.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <random>
#include <string>
#include <vector>

#include "palpate/fields/field.h"

namespace palpate::test {

/// One field and the facts about it that are known independently.
struct FieldCase {
  std::string name;                ///< letters, digits and _, unique in its instantiation
  std::function<FieldPtr()> make;  ///< called once for each check
  Box3 region;                     ///< [m] bounded; most points are drawn from it

  /// Membership, computed independently of the field: true inside. Without it the field's own sign
  /// is used, which still checks that metric and bounds agree with the zero set.
  std::function<bool(const Vec3&)> inside{};

  std::vector<Vec3> awkward{};  ///< [m] centers, edges, apexes, in addition to those of the suite

  double gradient_tolerance = 1e-6;  ///< [-] of |gradient| (at least L/100), against differences
  double hessian_tolerance = 1e-4;   ///< [-] of 1/featureSize(), against central differences
  double distance_tolerance = 1e-6;  ///< [-] of the region's diagonal, against brute force
  double sign_margin = 1e-12;  ///< [-] of the diagonal; nearer to the surface the sign is uncertain
  double difference_step = 1e-5;  ///< [-] of featureSize(), for central differences
  /// Share of the points that may be at a crease and are then not checked
  double crease_share = 0.1;
  bool unit_gradient = true;  ///< exact fields: |gradient| = 1 in the band, to 1e-9
  bool far_away = true;       ///< also try 1e300: not for a field that is a polynomial
};

void PrintTo(const FieldCase& field_case, std::ostream* out);

/// Reproducible numbers, the same on every platform (std distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  [[nodiscard]] double uniform(double lo, double hi);
  [[nodiscard]] Vec3 in(const Box3& box);
  [[nodiscard]] Vec3 direction();

 private:
  std::mt19937_64 engine_;
};

/// gradient against central differences of value, except where the gradient itself jumps.
[[nodiscard]] ::testing::AssertionResult checkGradient(const FieldCase& field_case);
/// value < 0 exactly where `inside` says so.
[[nodiscard]] ::testing::AssertionResult checkSign(const FieldCase& field_case);
/// No inside point lies outside bounds(), not even a hair's breadth beyond its faces.
[[nodiscard]] ::testing::AssertionResult checkBounds(const FieldCase& field_case);
/// No pair of points in lipschitzDomain() has a steeper slope than lipschitz(), searched uphill.
[[nodiscard]] ::testing::AssertionResult checkLipschitz(const FieldCase& field_case);
/// |value| compared with the distance found by shooting at the border of `inside`: equal for exact
/// fields, never larger for bounds, sign only for implicit ones.
[[nodiscard]] ::testing::AssertionResult checkMetric(const FieldCase& field_case);
/// jet() has the value and gradient of sample(), and the Hessian given by differences of the
/// gradient.
[[nodiscard]] ::testing::AssertionResult checkJet(const FieldCase& field_case);
/// value() is sample().value, bit for bit.
[[nodiscard]] ::testing::AssertionResult checkValue(const FieldCase& field_case);
/// values() of a batch equals value() of each point, bit for bit, wherever the point is in the
/// batch.
[[nodiscard]] ::testing::AssertionResult checkValues(const FieldCase& field_case);
/// Only finite numbers and usable gradients at the awkward points; no finite value for a point that
/// is not finite.
[[nodiscard]] ::testing::AssertionResult checkAwkward(const FieldCase& field_case);
/// Constants are in range and consistent.
[[nodiscard]] ::testing::AssertionResult checkConstants(const FieldCase& field_case);

class FieldContract : public ::testing::TestWithParam<FieldCase> {};

}  // namespace palpate::test
