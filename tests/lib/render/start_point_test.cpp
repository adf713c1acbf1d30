// The proxy's starting place if no leaf's field leads to its region, as with a grid outside its
// band.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// A field that has the right sign everywhere, but the right value and gradient only within `band`
/// [m] of its surface.
class NarrowBand final : public Field {
 public:
  NarrowBand(FieldPtr whole, double band) : whole_(std::move(whole)), band_(band) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample s = whole_->sample(p);
    if (std::fabs(s.value) < band_) return s;
    return {std::copysign(band_, s.value), Vec3(0.0), false};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return sample(p).value; }
  [[nodiscard]] Box3 bounds() const noexcept override { return whole_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return whole_->lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return whole_->featureSize(); }

 private:
  FieldPtr whole_;
  double band_;
};

/// Makes the first tick with the hand at `hip`; returns the proxy, the place found in the region
/// `solid`.
Vec3 begunAt(const FieldPtr& solid, const Vec3& hip) {
  Drive hand(sceneOfSolid(std::make_shared<NarrowBand>(solid, 1e-3), true));
  const TickResult out = hand.to(hip);
  EXPECT_EQ(hand.region(), "solid");
  return out.proxy;
}

TEST(StartPoint, ARegionWithoutBoundsIsFoundAMeterOff) {
  // Nine tenths of a meter away, in any direction: between the 48 directions of the search there is
  // no gap wider than 25 degrees.
  for (const Vec3& side : {Vec3(1, -1, 0), Vec3(-1, 1, 0), Vec3(1, 1, 1), Vec3(-1, 1, 1),
                           Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, -1, 0)}) {
    const Vec3 u = glm::normalize(side);
    const Vec3 found = begunAt(halfSpace(0.9 * u, -u), Vec3(0.0));
    EXPECT_GE(glm::dot(found, u), 0.9 - 1e-6) << Judge::text(u);
    EXPECT_LT(glm::length(found), 1.0 + 1e-9) << Judge::text(u);
  }
}

TEST(StartPoint, ABallIsFoundFromAllSides) {
  const Vec3 center(0.01, -0.02, 0.03);
  constexpr double kRadius = 0.03;
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    // Seen from two radii away, the ball extends 30 degrees to each side.
    const Vec3 hip = center + 2.0 * kRadius * random.direction();
    const Vec3 found = begunAt(sphere(center, kRadius), hip);
    EXPECT_LE(glm::length(found - center), kRadius * (1.0 + 1e-6)) << Judge::text(hip);
  }
}

TEST(StartPoint, ABallThatNoLookAroundWouldHitIsFoundByItsField) {
  // Seen from 300 radii away, it extends 0.2 degrees: a search in 48 directions misses it.
  constexpr double kRadius = 0.2e-3;
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Vec3 hip = 300.0 * kRadius * random.direction();
    Drive hand(sceneOfSolid(sphere(Vec3(0.0), kRadius), true));
    const TickResult out = hand.to(hip);
    EXPECT_EQ(hand.region(), "solid");
    // The nearest point of the ball.
    EXPECT_LE(glm::length(out.proxy - kRadius * glm::normalize(hip)), 1e-3 * kRadius)
        << Judge::text(hip);
  }
}

}  // namespace
}  // namespace palpate::test
