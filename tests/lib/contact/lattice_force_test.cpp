// The lattice's force against its formula and as the gradient of its energy, also where its
// amplitude varies.

#include "palpate/contact/lattice_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::test {
namespace {

constexpr double kPi = std::numbers::pi;

Lattice sampleLattice() {
  Lattice lattice;
  lattice.force = 0.4;
  lattice.wavelength = Vec3(4e-3, 6e-3, 0.0);
  lattice.origin = Vec3(1e-3, 0.0, 0.0);
  return lattice;
}

TEST(LatticeForce, IsASineAlongEachAxis) {
  const Lattice lattice = sampleLattice();
  const auto push = [&](const Vec3& p) {
    return latticePush(lattice, lattice.force.sample(p), p).force;
  };
  EXPECT_EQ(push(lattice.origin), Vec3(0.0));
  EXPECT_NEAR(push(Vec3(2e-3, 0.0, 0.0)).x, -0.4, 1e-15);  // a quarter of a wavelength further
  EXPECT_NEAR(push(Vec3(0.0, 0.0, 0.0)).x, 0.4, 1e-15);    // a quarter of a wavelength back
  EXPECT_NEAR(push(Vec3(1e-3, 1.5e-3, 5e-3)).y, -0.4, 1e-15);
  EXPECT_EQ(push(Vec3(1e-3, 1.5e-3, 5e-3)).z, 0.0);  // no waves along z
}

TEST(LatticeForce, IsTheSlopeOfItsEnergy) {
  const Lattice lattice = sampleLattice();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-0.01, 0.01);
  const Vec3 slope(30.0, -20.0, 50.0);  // [N/m] gradient of an amplitude that varies
  const auto at = [&](const Vec3& p) {
    return latticePush(lattice, {0.4 + glm::dot(slope, p), slope}, p);
  };
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(place(random), place(random), place(random));
    const Vec3 force = at(p).force;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 h(0.0);
      h[axis] = 1e-6;
      // Error of central differences: h^2 / 6 of the third derivative, which is 0.6 k^2 or less.
      EXPECT_NEAR(force[axis], -(at(p + h).energy - at(p - h).energy) / 2e-6, 1e-6);
    }
  }
}

TEST(LatticeForce, HighestForceIsWhereItIsAsStiffAsItsMaterial) {
  Lattice lattice = sampleLattice();
  const double highest = lattice.highestForce(500.0);
  EXPECT_NEAR(highest, 500.0 * 4e-3 / (2.0 * kPi), 1e-15);
  const double h = 1e-8;
  const auto push = [&](double x) {
    const Vec3 p = lattice.origin + Vec3(x, 0.0, 0.0);
    return latticePush(lattice, {highest, Vec3(0.0)}, p).force.x;
  };
  EXPECT_NEAR((push(-h) - push(h)) / (2.0 * h), 500.0, 1e-3);
}

}  // namespace
}  // namespace palpate::test
