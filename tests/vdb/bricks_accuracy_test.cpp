// The error of the cubic spline for surfaces whose distance is known.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "support/field_contract.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::test::Random;

struct Errors {
  double value = 0.0;   ///< [m] RMS
  double normal = 0.0;  ///< [radian] RMS
};

/// The errors at `count` points of `region` within one voxel of the surface.
Errors errorsOf(const Field& grid, const Field& exact, const Box3& region, double voxel,
                int count) {
  Random random(11);
  Errors errors;
  for (int i = 0; i < count;) {
    const Vec3 p = random.in(region);
    const FieldSample wanted = exact.sample(p);
    if (std::abs(wanted.value) > voxel) continue;
    ++i;
    const FieldSample found = grid.sample(p);
    EXPECT_TRUE(found.in_band);
    const double value = found.value - wanted.value;
    const double sine =
        glm::length(glm::cross(found.gradient, wanted.gradient)) / glm::length(found.gradient);
    errors.value += value * value / count;
    errors.normal += sine * sine / count;
  }
  return {std::sqrt(errors.value), std::sqrt(errors.normal)};
}

FieldPtr cubic(const Field& field, double voxel, const std::optional<Box3>& box = {}) {
  BakeOptions options = voxels(voxel);
  options.box = box;
  return gridField(bake(field, options));
}

constexpr double kDegree = std::numbers::pi / 180.0;
const Vec3 kCenter(0.3e-3, -0.2e-3, 0.1e-3);
const Vec3 kAxis = glm::normalize(Vec3(0.3, 0.5, 0.8));

TEST(BricksAccuracy, TorusOfFifteenVoxels) {
  const FieldPtr exact = palpate::torus(kCenter, kAxis, 35e-3, 15e-3);
  const FieldPtr grid = cubic(*exact, 1e-3);
  const Errors errors = errorsOf(*grid, *exact, exact->bounds().grownBy(1e-3), 1e-3, 50000);
  std::printf("value %.3g mm, normal %.4g degree RMS\n", 1e3 * errors.value,
              errors.normal / kDegree);
  EXPECT_LE(errors.value, 2e-9);
  EXPECT_LE(errors.normal, 1.8e-4 * kDegree);

  // Far from the world's origin positions have fewer digits; nothing else changes.
  const Vec3 away(3.0, -2.0, 5.0);
  const FieldPtr moved = palpate::torus(kCenter + away, kAxis, 35e-3, 15e-3);
  const Errors there =
      errorsOf(*cubic(*moved, 1e-3), *moved, moved->bounds().grownBy(1e-3), 1e-3, 50000);
  EXPECT_LE(there.value, 2e-9);
  EXPECT_LE(there.normal, 1.8e-4 * kDegree);
}

/// The second difference of the normal along a stroke with steps of 0.2 mm is the jump of the
/// force. The spline adds less than 5 % to that of the surface.
TEST(BricksAccuracy, AStrokeFeelsTheSurfaceAndNotTheVoxels) {
  const FieldPtr exact = palpate::torus(kCenter, kAxis, 35e-3, 15e-3);
  const FieldPtr grid = cubic(*exact, 1e-3);
  Vec3 p = kCenter + Vec3(30e-3, 20e-3, 10e-3);
  Vec3 direction = glm::normalize(Vec3(0.3, -1.0, 0.4));
  std::vector<Vec3> found, wanted;
  for (int i = 0; i < 5000; ++i) {
    for (int n = 0; n < 3; ++n) p -= exact->value(p) * exact->sample(p).gradient;
    const Vec3 normal = exact->sample(p).gradient;
    wanted.push_back(normal);
    found.push_back(glm::normalize(grid->sample(p).gradient));
    direction = glm::normalize(direction - glm::dot(direction, normal) * normal);
    p += 0.2e-3 * direction;
  }
  const auto jitter = [](const std::vector<Vec3>& n) {
    double square = 0.0, most = 0.0;
    for (std::size_t i = 2; i < n.size(); ++i) {
      const double jump = glm::length(n[i] - 2.0 * n[i - 1] + n[i - 2]);
      square += jump * jump;
      most = std::max(most, jump);
    }
    return std::pair(std::sqrt(square / static_cast<double>(n.size())), most);
  };
  const auto [rms, most] = jitter(found);
  const auto [true_rms, true_most] = jitter(wanted);
  EXPECT_NEAR(rms, true_rms, 0.05 * true_rms);
  EXPECT_NEAR(most, true_most, 0.05 * true_most);
}

/// Errors for several ratios r / voxel, and the orders between the first and the last. Returns the
/// errors of the last one.
Errors expectOrders(const char* name, const Field& exact, const Box3& region, double radius,
                    const std::vector<double>& ratios, const std::optional<Box3>& box = {}) {
  std::vector<Errors> all;
  for (const double ratio : ratios) {
    const double voxel = radius / ratio;
    all.push_back(errorsOf(*cubic(exact, voxel, box), exact, region, voxel, 8000));
    std::printf("%-7s r/h %5.1f: value %.3g r, normal %.3g degree\n", name, ratio,
                all.back().value / radius, all.back().normal / kDegree);
  }
  const double span = std::log(ratios.back() / ratios.front());
  EXPECT_GE(std::log(all.front().value / all.back().value) / span, 3.8) << name;
  EXPECT_GE(std::log(all.front().normal / all.back().normal) / span, 3.0) << name;
  return all.back();
}

TEST(BricksAccuracy, ConvergesWithTheFourthAndThirdPowerOfTheVoxel) {
  const FieldPtr ball = sphere(kCenter, 10e-3);
  expectOrders("sphere", *ball, ball->bounds().grownBy(2e-3), 10e-3, {4.0, 8.0, 16.0, 40.0});
  const FieldPtr ring = palpate::torus(kCenter, kAxis, 12e-3, 5e-3);
  expectOrders("torus", *ring, ring->bounds().grownBy(1e-3), 5e-3, {4.0, 10.0, 20.0, 40.0});
}

/// The distance to the zero set of a smooth function, by Newton's method for the closest point.
FieldPtr distanceTo(const FieldPtr& function, const Box3& bounds) {
  const auto sample = [=](const Vec3& x) {
    Vec3 q = x;
    Vec3 normal(0.0);
    for (int step = 0; step < 200; ++step) {
      const FieldSample s = function->sample(q);
      const double length = glm::length(s.gradient);
      normal = s.gradient / length;
      // One step to the tangent plane, and one along it towards x. The sideways part is damped
      // because of curvature.
      const Vec3 across = (x - q) - glm::dot(x - q, normal) * normal;
      const Vec3 move = 0.7 * across - normal * (s.value / length);
      q += move;
      if (glm::length(move) < 1e-13) break;
    }
    const double distance = glm::dot(x - q, normal);
    return FieldSample{distance, normal, true};
  };
  FunctionField::Claims claims{bounds};
  // Where Newton's method finds a point that is not the closest, the value jumps and is too large.
  // A bake drops voxels that this bound puts outside the band; a tight bound would lose some.
  claims.lipschitz = 16.0;
  return std::make_shared<FunctionField>(sample, claims);
}

TEST(BricksAccuracy, ConvergesOnAGyroid) {
  // Period 40 mm: its smallest radius of curvature is about a sixth of that.
  const FieldPtr function = palpate::gyroid(Vec3(0.0), 40e-3);
  const Box3 box{Vec3(-9e-3), Vec3(9e-3)};
  const FieldPtr exact = distanceTo(function, box);
  // The region keeps away from the cutting faces, where the box would decide.
  const Box3 region{Vec3(-3e-3), Vec3(3e-3)};
  const double radius = 6e-3;
  const Errors coarse = expectOrders("gyroid", *exact, region, radius, {8.0, 16.0}, box);
  if (std::getenv("PALPATE_SLOW_TESTS") == nullptr) return;
  // With voxels of 0.15 mm the error is down to the precision of the grid's floats: 2e-8 mm and
  // 3e-6 degree.
  const double voxel = radius / 40.0;
  const Errors fine = errorsOf(*cubic(*exact, voxel, box), *exact, region, voxel, 8000);
  std::printf("gyroid  r/h  40.0: value %.3g r, normal %.3g degree\n", fine.value / radius,
              fine.normal / kDegree);
  EXPECT_LE(fine.value, coarse.value * std::pow(16.0 / 40.0, 3.8) + 2e-11);
  EXPECT_LE(fine.normal, coarse.normal * std::pow(16.0 / 40.0, 3.0) + 3e-6 * kDegree);
}

}  // namespace
}  // namespace palpate::vdb
