#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRate = 1000.0;
// Positions are of order 0.1 m and come from a handful of operations.
constexpr double kRounding = 1e-15;

/// Rows are at i / rate, exactly, so that a path is the same on every machine.
void expectSampled(const Path& path, double rate) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_EQ(path[i].t, static_cast<double>(i) / rate);
  }
}

double fastest(const Path& path) {
  double most = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    most = std::max(
        most, glm::length(path[i].position - path[i - 1].position) / (path[i].t - path[i - 1].t));
  }
  return most;
}

TEST(PressPath, FollowsItsFormula) {
  PressPath press;
  press.surface = Vec3(0.01, 0.02, 0.03);
  press.normal = Vec3(0.0, 0.0, 2.0);  // any length
  press.depth = 0.002;
  press.clearance = 0.005;
  press.speed = 0.05;
  press.hold = 0.2;
  const Path path = generate(press, kRate);
  // 7 mm at 50 mm/s take 140 ms each way, plus 200 ms of hold.
  ASSERT_EQ(path.size(), 481U);
  expectSampled(path, kRate);
  for (const PathPoint& point : path) {
    const double down = 0.005 - 0.05 * point.t;
    const double up = -0.002 + 0.05 * (point.t - 0.34);
    const double height = std::max({-0.002, down, up});
    EXPECT_NEAR(point.position.z - 0.03, height, kRounding) << point.t;
    EXPECT_EQ(point.position.x, 0.01);
    EXPECT_EQ(point.position.y, 0.02);
  }
  EXPECT_EQ(path.front().position, Vec3(0.01, 0.02, 0.03 + 0.005));
  EXPECT_EQ(path.back().position, path.front().position);
  // During the hold, the position is the deepest point to the last bit, without rounding.
  EXPECT_EQ(path[240].position, Vec3(0.01, 0.02, 0.03 - 0.002));
  EXPECT_NEAR(fastest(path), 0.05, 1e-9);
}

TEST(PressPath, EndsExactlyWhereItBeganThoughTheRateDoesNotDivide) {
  PressPath press;
  press.normal = Vec3(1.0, 2.0, -0.3);
  press.hold = 0.0123;
  const Path path = generate(press, 997.0);
  expectSampled(path, 997.0);
  EXPECT_EQ(path.back().position, path.front().position);
  const double duration = 2.0 * 0.007 / 0.05 + 0.0123;
  EXPECT_GE(path.back().t, duration);
  EXPECT_LT(path[path.size() - 2].t, duration);
}

TEST(StrokePath, GoesThereAndBackAtConstantSpeed) {
  StrokePath stroke;
  stroke.from = Vec3(-0.03, 0.0, 0.01);
  stroke.to = Vec3(0.01, 0.03, 0.01);  // 50 mm
  stroke.speed = 0.1;
  stroke.repeats = 3;
  const Path path = generate(stroke, kRate);
  ASSERT_EQ(path.size(), 3001U);
  expectSampled(path, kRate);
  for (const PathPoint& point : path) {
    const double along = std::fabs(std::remainder(0.1 * point.t, 0.1)) / 0.05;
    const Vec3 expected = stroke.from + along * (stroke.to - stroke.from);
    // The remainder after a way of 0.3 m is rounded at 0.3 m.
    EXPECT_LT(glm::length(point.position - expected), 1e-15 * 10) << point.t;
  }
  EXPECT_EQ(path.front().position, stroke.from);
  EXPECT_EQ(path[500].position, stroke.to);
  EXPECT_EQ(path.back().position, stroke.from);
}

TEST(TapPath, IsACosineBetweenClearanceAndDepth) {
  TapPath tap;
  tap.surface = Vec3(0.0, 0.1, 0.0);
  tap.normal = Vec3(0.0, -3.0, 0.0);
  tap.depth = 0.002;
  tap.clearance = 0.006;
  tap.frequency = 4.0;
  tap.taps = 4;
  const Path path = generate(tap, kRate);
  ASSERT_EQ(path.size(), 1001U);
  expectSampled(path, kRate);
  for (const PathPoint& point : path) {
    const double height = 0.002 + 0.004 * std::cos(2.0 * std::numbers::pi * 4.0 * point.t);
    // Here the phase grows to 100 rad, with the rounding of such a number; the path's stays below 2
    // pi.
    EXPECT_NEAR(0.1 - point.position.y, height, 1e-15 * 100) << point.t;
  }
  EXPECT_EQ(path.front().position, Vec3(0.0, 0.1 - 0.006, 0.0));
  EXPECT_EQ(path.back().position, path.front().position);
  const auto deepest = std::max_element(
      path.begin(), path.end(),
      [](const PathPoint& a, const PathPoint& b) { return a.position.y < b.position.y; });
  EXPECT_NEAR(deepest->position.y, 0.102, kRounding);
  EXPECT_DOUBLE_EQ(deepest->t, 0.125);
}

TEST(InsertPath, RunsThroughItsWayPointsHoldsAndComesBack) {
  InsertPath insert;
  insert.points = {Vec3(0.0), Vec3(0.0, 0.0, -0.02), Vec3(0.03, 0.0, -0.02)};
  insert.speed = 0.05;
  insert.hold = 0.1;
  const Path path = generate(insert, kRate);
  ASSERT_EQ(path.size(), 1000U + 100U + 1000U + 1U);
  expectSampled(path, kRate);
  for (const PathPoint& point : path) {
    const double there = std::min(0.05 * point.t, 0.05);
    const double s = point.t < 1.05 ? there : std::min(0.05, 0.05 - 0.05 * (point.t - 1.1));
    const Vec3 expected = s < 0.02 ? Vec3(0.0, 0.0, -s) : Vec3(s - 0.02, 0.0, -0.02);
    EXPECT_LT(glm::length(point.position - expected), 10 * kRounding) << point.t;
  }
  EXPECT_EQ(path.front().position, insert.points[0]);
  EXPECT_EQ(path[1050].position, insert.points[2]);
  EXPECT_EQ(path.back().position, insert.points[0]);
}

TEST(InsertPath, WithoutBackEndsAtTheFarPoint) {
  InsertPath insert;
  insert.points = {Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3), Vec3(-0.1, 0.0, 0.7)};
  insert.back = false;
  const Path path = generate(insert, kRate);
  EXPECT_EQ(path.front().position, insert.points.front());
  EXPECT_EQ(path.back().position, insert.points.back());
  const double length = glm::length(insert.points[2] - insert.points[0]);
  EXPECT_NEAR(path.back().t, length / insert.speed + insert.hold, 1.0 / kRate);
}

TEST(Generators, TheSameTwiceIsTheSameToTheBit) {
  TapPath tap;
  tap.normal = Vec3(0.3, 0.4, 0.5);
  const Path a = generate(tap, 12345.0);
  const Path b = generate(tap, 12345.0);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].position, b[i].position);
}

template <typename Shape>
void expectRefused(const Shape& shape, double rate = kRate) {
  try {
    static_cast<void>(generate(shape, rate));
    ADD_FAILURE() << "was made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, "path.parameter");
  }
}

TEST(Generators, RefuseParametersOutOfRange) {
  const std::vector<Vec3> two{Vec3(0.0), Vec3(0.01)};
  for (const double rate : {0.0, -1.0, kNan, kInfinity}) {
    expectRefused(PressPath{}, rate);
    expectRefused(TapPath{}, rate);
    expectRefused(StrokePath{.from = Vec3(0.0), .to = Vec3(0.1)}, rate);
    expectRefused(InsertPath{.points = two}, rate);
  }
  for (const double bad : {-0.001, kNan, kInfinity}) {
    expectRefused(PressPath{.depth = bad});
    expectRefused(PressPath{.clearance = bad});
    expectRefused(PressPath{.hold = bad});
    expectRefused(TapPath{.depth = bad});
    expectRefused(TapPath{.clearance = bad});
    expectRefused(InsertPath{.points = two, .hold = bad});
  }
  for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
    expectRefused(PressPath{.speed = bad});
    expectRefused(StrokePath{.from = Vec3(0.0), .to = Vec3(0.1), .speed = bad});
    expectRefused(TapPath{.frequency = bad});
    expectRefused(InsertPath{.points = two, .speed = bad});
  }
  expectRefused(PressPath{.normal = Vec3(0.0)});
  expectRefused(PressPath{.surface = Vec3(kNan)});
  expectRefused(PressPath{.depth = 0.0, .clearance = 0.0});
  expectRefused(TapPath{.normal = Vec3(0.0)});
  expectRefused(TapPath{.depth = 0.0, .clearance = 0.0});
  expectRefused(TapPath{.taps = 0});
  expectRefused(StrokePath{});
  expectRefused(StrokePath{.from = Vec3(0.0), .to = Vec3(0.1), .repeats = 0});
  expectRefused(InsertPath{});
  expectRefused(InsertPath{.points = {Vec3(0.0)}});
  expectRefused(InsertPath{.points = {Vec3(0.1), Vec3(0.1)}});
  expectRefused(InsertPath{.points = {Vec3(0.0), Vec3(kInfinity)}});
}

TEST(Generators, RefuseAPathTooLongToHold) { expectRefused(PressPath{.speed = 1e-12}); }

// The rows computed one by one equal those kept in memory, bit for bit, and a hand that follows
// them is the same.
TEST(PathFormula, IsThePathThatIsGenerated) {
  const auto compare = [](const auto& shape, double rate) {
    const Path path = generate(shape, rate);
    const PathFormula rows = formula(shape, rate);
    ASSERT_EQ(rows.size(), path.size());
    VirtualDevice kept(path);
    VirtualDevice computed(rows);
    kept.open();
    computed.open();
    EXPECT_EQ(kept.info().workspace.lo, computed.info().workspace.lo);
    EXPECT_EQ(kept.info().workspace.hi, computed.info().workspace.hi);
    for (std::size_t i = 0; i < path.size(); ++i) {
      ASSERT_EQ(rows.at(i).t, path[i].t);
      ASSERT_EQ(rows.at(i).position, path[i].position);
      DeviceState a;
      DeviceState b;
      ASSERT_EQ(kept.read(a), DeviceStatus::kOk);
      const testing::AllocGuard guard;
      const DeviceStatus status = computed.read(b);
      ASSERT_EQ(guard.violations(), 0);
      ASSERT_EQ(status, DeviceStatus::kOk);
      ASSERT_EQ(a.time, b.time);
      ASSERT_EQ(a.position, b.position);
      ASSERT_EQ(a.velocity, b.velocity);
    }
    DeviceState none;
    EXPECT_EQ(computed.read(none), DeviceStatus::kEnd);
  };
  compare(PressPath{.surface = {0.01, 0.0, 0.02}, .normal = {0.3, 0.2, 1.0}}, 997.0);
  compare(StrokePath{.from = {0.0, 0.0, 0.0}, .to = {0.03, 0.01, 0.0}, .repeats = 2}, 1000.0);
  compare(TapPath{.taps = 2}, 1234.5);
  compare(InsertPath{.points = {{0.0, 0.0, 0.03}, {0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}}}, 1000.0);
}

}  // namespace
}  // namespace palpate::devices
