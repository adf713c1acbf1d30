// The usual ticks evaluate the fields as rarely as the fast ways promise. If the fast way gives up,
// the general one ends at the same place with the same force, so only the cost shows it.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

struct Calls {
  int jets = 0;
  int others = 0;  ///< calls of sample() and value()

  [[nodiscard]] int all() const { return jets + others; }
};

/// A field that counts its evaluations. For one thread.
class Counted final : public Field {
 public:
  Counted(FieldPtr field, Calls& calls) : field_(std::move(field)), calls_(calls) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    ++calls_.others;
    return field_->sample(p);
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    ++calls_.others;
    return field_->value(p);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    ++calls_.jets;
    return field_->jet(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return field_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return field_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return field_->featureSize(); }
  [[nodiscard]] bool isFlat() const noexcept override { return field_->isFlat(); }

 private:
  FieldPtr field_;
  Calls& calls_;
};

/// The most calls of one tick while the hand moves along `way`, one place for each tick; the first
/// ticks bring the hand there.
struct Most {
  int jets = 0;
  int all = 0;
};

Most mostCalls(const ScenePtr& scene, Calls& calls, const Vec3& from,
               const std::function<Vec3(int)>& way, int ticks) {
  Drive drive(scene);
  (void)drive.to(from);
  (void)drive.walk(way(0), 1e-4);
  Most most;
  for (int i = 1; i <= ticks; ++i) {
    calls = {};
    const TickResult& out = drive.to(way(i));
    EXPECT_TRUE(out.settled && out.contact) << i;
    most.jets = std::max(most.jets, calls.jets);
    most.all = std::max(most.all, calls.all());
  }
  return most;
}

class FieldCalls : public ::testing::Test {
 protected:
  FieldPtr counted(FieldPtr field) { return std::make_shared<Counted>(std::move(field), calls_); }
  /// Checks the most evaluations in a tick along `way` of `ticks` ticks.
  void expect(const ScenePtr& scene, const Vec3& from, const std::function<Vec3(int)>& way,
              int ticks, int jets, int all) {
    const Most most = mostCalls(scene, calls_, from, way, ticks);
    EXPECT_LE(most.jets, jets);
    EXPECT_LE(most.all, all);
  }

  Calls calls_;
};

/// The hand's path on a circle of `radius` [m] that is not in a coordinate plane.
std::function<Vec3(int)> circle(double radius, double step) {
  return [=](int i) {
    const double turn = step * i;
    return radius * Vec3(std::cos(turn), 0.8 * std::sin(turn), 0.6 * std::sin(turn));
  };
}

TEST_F(FieldCalls, ABallIsAskedOnceAndAHandAtRestNever) {
  const ScenePtr scene = sceneOfSolid(counted(sphere(Vec3(0.0), 0.02)));
  expect(scene, mm(30, 0, 0), circle(0.019, 0.005), 1000, 1, 1);
  expect(scene, mm(30, 0, 0), circle(0.019, 0.0), 20, 0, 0);
  const ScenePtr hollow = sceneOfSolid(counted(sphere(Vec3(0.0), 0.02)), true);
  expect(hollow, Vec3(0.0), circle(0.021, 0.005), 1000, 1, 1);
}

TEST_F(FieldCalls, APlaneIsAskedOnceWithFrictionToo) {
  Material rough;
  rough.stiffness = kDefaultK;
  rough.friction = {0.3, 0.2};
  const auto way = [](int i) { return mm(0.2 * i, 0, -1); };
  for (const Material& wall : {Material{}, rough}) {
    const ScenePtr scene = sceneOfSolid(counted(halfSpace(Vec3(0.0), Vec3(0, 0, 1))), false, wall);
    expect(scene, mm(0, 0, 5), way, 200, 1, 1);
  }
}

TEST_F(FieldCalls, AWallThatBendsUnevenlyIsAskedTwice) {
  const Vec3 radii = mm(30, 20, 15);
  expect(
      sceneOfSolid(counted(ellipsoid(Vec3(0.0), radii))), mm(40, 0, 0),
      [=](int i) {
        const Vec3 u = circle(1.0, 0.004)(i);
        return radii * u - 1e-3 * glm::normalize(u / radii);
      },
      1000, 2, 2);
  // Along a ring, the chord is checked as well.
  expect(
      sceneOfSolid(counted(torus(Vec3(0.0), Vec3(0, 0, 1), 0.04, 0.01))), mm(60, 0, 0),
      [](int i) {
        const double turn = 0.004 * i;
        const double around = 3.7 * turn;
        const double rho = 0.04 + 0.009 * std::cos(around);
        return Vec3(rho * std::cos(turn), rho * std::sin(turn), 0.009 * std::sin(around));
      },
      1000, 2, 3);
}

TEST_F(FieldCalls, BesideAnotherBallOneIsAskedOnce) {
  const ScenePtr scene = sceneOfSolid(
      unite({counted(sphere(mm(-20, 0, 0), 0.015)), counted(sphere(mm(20, 0, 0), 0.015))}));
  expect(
      scene, mm(-20, 30, 0),
      [](int i) {
        return mm(-20, 0, 0) + 0.014 * Vec3(std::cos(0.005 * i), std::sin(0.005 * i), 0.0);
      },
      1000, 1, 1);
}

TEST_F(FieldCalls, AlongACreaseEachOfTwoWallsIsAskedTwice) {
  const ScenePtr groove = sceneOfSolid(unite({counted(halfSpace(Vec3(0.0), Vec3(0.6, 0, 0.8))),
                                              counted(halfSpace(Vec3(0.0), Vec3(-0.6, 0, 0.8)))}));
  expect(
      groove, mm(0, 0, 5), [](int i) { return mm(0, 0.2 * i, -1); }, 200, 2, 6);
  // The hand goes into the crease, and out of it along either wall.
  expect(
      groove, mm(0, 0, 5), [](int i) { return mm(4.0 * std::sin(0.05 * i), 0.2 * i, -1); }, 400, 4,
      8);
  const ScenePtr balls = sceneOfSolid(
      unite({counted(sphere(mm(-20, 0, 0), 0.03)), counted(sphere(mm(20, 0, 0), 0.03))}));
  expect(
      balls, mm(0, 40, 0),
      [](int i) {
        const double turn = 0.005 * i;
        const double rho = std::sqrt(5e-4) - 2e-3;
        return Vec3(5e-4 * std::sin(7.3 * turn), rho * std::cos(turn), rho * std::sin(turn));
      },
      1000, 4, 8);
}

}  // namespace
}  // namespace palpate::test
