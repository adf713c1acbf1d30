// The mean of a map over the patch of a press: its gradients against differences, its spread
// against the moment of a disk.

#include "palpate/contact/contact_patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/field_contract.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

constexpr double kWave = 2e-3;  // [m]

Parameter waves() {
  return MaterialMapPtr(std::make_shared<testing::FunctionMap>(
      [](const Vec3& p) {
        const Vec3 q = p / kWave;
        const double value = 1000.0 + 300.0 * std::sin(q.x + 0.4 * q.z) * std::cos(0.7 * q.y);
        const double c = std::cos(q.x + 0.4 * q.z);
        const double s = std::sin(q.x + 0.4 * q.z);
        const Vec3 gradient(c * std::cos(0.7 * q.y), -0.7 * s * std::sin(0.7 * q.y),
                            0.4 * c * std::cos(0.7 * q.y));
        return MaterialMap::Sample{value, (300.0 / kWave) * gradient};
      },
      MaterialMap::Range{700.0, 1300.0}));
}

/// The gradient of `f` at `at`, by central differences.
Vec3 slope(const std::function<double(const Vec3&)>& f, const Vec3& at, double step) {
  Vec3 out(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 by(0.0);
    by[axis] = step;
    out[axis] = (f(at + by) - f(at - by)) / (2.0 * step);
  }
  return out;
}

TEST(OverPatch, ItsSlopesAreThoseOfItsValue) {
  const Parameter map = waves();
  Random random(3);
  // Errors: (step / length)^2 of the gradient, which is 1.5e5 N/m^2 and more, and the rounding of
  // 1e-13 of the value over the step.
  constexpr double kStep = 1e-8;
  constexpr double kTolerance = 0.05;
  // A point; few places; a blend of few and many (16 to 32 times the contrast); and many.
  for (const double contrast : {6e-3, 1e-3, 0.12e-3, 0.05e-3}) {
    for (int i = 0; i < 40; ++i) {
      const Vec3 middle = random.in({Vec3(-3e-3), Vec3(3e-3)});
      const Vec3 press = random.uniform(1e-3, 3e-3) * random.direction();
      const PatchSample here = overPatch(map, middle, press, contrast);
      const Vec3 by_place = slope(
          [&](const Vec3& p) { return overPatch(map, p, press, contrast).value; }, middle, kStep);
      const Vec3 by_press = slope(
          [&](const Vec3& p) { return overPatch(map, middle, p, contrast).value; }, press, kStep);
      EXPECT_LT(glm::length(here.by_place - by_place), kTolerance) << contrast;
      EXPECT_LT(glm::length(here.by_press - by_press), kTolerance) << contrast;
    }
  }
}

TEST(OverPatch, LiesAcrossThePressAndIsAsWideAsThePatch) {
  const Vec3 middle(1e-3, -2e-3, 0.5e-3);
  Random random(4);
  for (const double contrast : {1e-3, 0.05e-3}) {
    for (int i = 0; i < 20; ++i) {
      const double depth = random.uniform(1e-3, 3e-3);
      const Vec3 u = random.direction();
      const Vec3 along = glm::normalize(glm::cross(u, random.direction()));
      const double radius = patchRadius(depth, contrast);
      const auto mean_square = [&](const Vec3& direction) {
        const Parameter map = MaterialMapPtr(std::make_shared<testing::FunctionMap>(
            [&](const Vec3& p) {
              const double off = glm::dot(p - middle, direction);
              return MaterialMap::Sample{off * off, 2.0 * off * direction};
            },
            MaterialMap::Range{0.0, 1.0}));
        return overPatch(map, middle, depth * u, contrast).value;
      };
      EXPECT_NEAR(mean_square(u), 0.0, 1e-12 * radius * radius);
      // Evenly spread along any line: the mean square is a third of the radius squared. 24 places
      // are that even to some percent.
      EXPECT_NEAR(mean_square(along), radius * radius / 3.0, 0.05 * radius * radius / 3.0);
    }
  }
}

TEST(OverPatch, IsAPointDownToHalfTheContrast) {
  const Parameter map = waves();
  const Vec3 middle(0.3e-3, 0.2e-3, 0.0);
  const Vec3 press(0.0, 0.0, 1e-3);
  EXPECT_EQ(patchRadius(1e-3, 2e-3), 0.0);
  EXPECT_GT(patchRadius(1e-3, 1.9e-3), 0.0);
  EXPECT_EQ(patchRadius(5.0, kInfinity), 0.0);
  // At great depth the radius is the depth minus the contrast.
  EXPECT_NEAR(patchRadius(0.1, 1e-3), 0.099, 1e-5);
  EXPECT_EQ(overPatch(map, middle, press, 2e-3).value, map.at(middle));
  EXPECT_NE(overPatch(map, middle, press, 1e-3).value, map.at(middle));
}

}  // namespace
}  // namespace palpate::test
