// Walls of several kinds in series with one stop: the force is minus the gradient of the energy,
// whatever the shapes.

#include "palpate/contact/series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lib/contact/outside_of.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Each wall is a kind of its own, with a height and a stiffness that vary along it.
class Kinds final : public SoftKinds {
 public:
  Kinds(std::vector<FieldPtr> fields, const std::vector<WallLaw>& laws)
      : fields_(std::move(fields)), walls_(fields_.size()), laws_(laws) {
    putProxy(Vec3(0.0));
  }
  /// Sets the laws to those at the proxy: bumps and a stiffness that differ from place to place.
  void putProxy(const Vec3& p) {
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      SharedWall felt;
      felt.law = laws_[i];
      felt.law.height = 0.1e-3 * std::sin(900.0 * p.x + 0.3) * std::cos(700.0 * p.y);
      felt.height_rise =
          0.1e-3 * Vec3(900.0 * std::cos(900.0 * p.x + 0.3) * std::cos(700.0 * p.y),
                        -700.0 * std::sin(900.0 * p.x + 0.3) * std::sin(700.0 * p.y), 0);
      felt.law.spring.stiffness *= 1.0 + 40.0 * p.y;
      felt.stiffness_rise = Vec3(0, 40.0 * laws_[i].spring.stiffness, 0);
      if (!varies_) {
        felt = {};
        felt.law = laws_[i];
      }
      walls_[i] = {};
      walls_[i].add(felt);
    }
  }
  void vary() {
    varies_ = true;
    putProxy(Vec3(0.0));
  }
  [[nodiscard]] std::size_t count() const noexcept override { return fields_.size(); }
  [[nodiscard]] LocalProjection nearest(std::size_t index, const Vec3& from,
                                        const Vec3& place) noexcept override {
    const HeldWall wall = outsideOf(fields_[index]);
    return projectLocally(from, place, {&wall, 1});
  }
  [[nodiscard]] const SharedWalls& law(std::size_t index) const noexcept override {
    return walls_[index];
  }
  [[nodiscard]] Change change(std::size_t /*index*/,
                              const LocalProjection& /*on*/) const noexcept override {
    return {};
  }

 private:
  std::vector<FieldPtr> fields_;
  std::vector<SharedWalls> walls_;
  std::vector<WallLaw> laws_;
  bool varies_ = false;
};

TEST(SeriesForce, IsMinusTheSlopeOfTheEnergy) {
  const std::vector<std::vector<FieldPtr>> shapes{
      {halfSpace(Vec3(0.0), glm::normalize(Vec3(1, 0, 0.6))),
       halfSpace(Vec3(0.0), glm::normalize(Vec3(-1, 0.2, 0.7)))},
      {sphere(Vec3(-0.006, 0, -0.008), 0.01), sphere(Vec3(0.006, 0, -0.008), 0.01)},
      {halfSpace(Vec3(0.0), glm::normalize(Vec3(1, 0, 0.6))),
       halfSpace(Vec3(0.0), glm::normalize(Vec3(-1, 0.9, 0.7))), sphere(Vec3(0, -0.01, 0), 0.01)}};
  const WallLaw straight{{700.0, 0.0, 1.0, 1.0}};
  const WallLaw hertz{{900.0, 0.0, 1.5, 1e-3}};
  const WallLaw okamura{{400.0, 2e5, 1.0, 1.0}};
  Random random(7);
  int settled = 0;
  for (const auto& fields : shapes) {
    for (const bool varies : {false, true}) {
      Kinds kinds(fields, {straight, hertz, okamura});
      if (varies) kinds.vary();
      for (int i = 0; i < 40; ++i) {
        const Vec3 hand(random.uniform(-0.3e-3, 0.3e-3), random.uniform(-0.3e-3, 0.3e-3),
                        random.uniform(-1e-3, -0.2e-3));
        const Vec3 proxy(0.0);
        const double stop = 4000.0;
        const SeriesForce here = seriesForce(proxy, hand, stop, kinds);
        settled += here.settled ? 1 : 0;
        for (int axis = 0; axis < 3; ++axis) {
          Vec3 by(0.0);
          by[axis] = 1e-7;
          const double slope = (seriesForce(proxy, hand + by, stop, kinds).energy -
                                seriesForce(proxy, hand - by, stop, kinds).energy) /
                               2e-7;
          // The difference over 0.2 um of energies of some 1e-4 J, each known to 1e-16 of its
          // value.
          EXPECT_NEAR(here.force[axis], -slope, 1e-6) << i << " " << varies;
        }
        EXPECT_EQ(here.varies, varies);
        for (int axis = 0; axis < 2; ++axis) {
          Vec3 by(0.0);
          by[axis] = 1e-7;
          kinds.putProxy(by);
          const double after = seriesForce(proxy, hand, stop, kinds).energy;
          kinds.putProxy(-by);
          const double before = seriesForce(proxy, hand, stop, kinds).energy;
          kinds.putProxy(proxy);
          EXPECT_NEAR(here.rise[axis], (after - before) / 2e-7, 1e-6) << i;
        }
      }
    }
  }
  EXPECT_EQ(settled, 240);
}

TEST(SeriesForce, OfOneKindIsItsOwnLaw) {
  const WallLaw hertz{{900.0, 0.0, 1.5, 1e-3}};
  Kinds kinds({halfSpace(Vec3(0.0), Vec3(0, 0, 1))}, {hertz});
  for (double d = 0.05e-3; d < 2e-3; d += 0.05e-3) {
    const SeriesForce out = seriesForce(Vec3(0.0), Vec3(0, 0, -d), 4000.0, kinds);
    EXPECT_NEAR(out.force.z, hertz.force(d), 1e-10);
    EXPECT_NEAR(out.energy, hertz.energy(d), 1e-14);
  }
}

}  // namespace
}  // namespace palpate::test
