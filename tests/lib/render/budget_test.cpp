// A tick that runs out of its budget: the proxy stays at a permitted point, never farther from the
// hand than the proxy of the previous tick.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "lib/render/drive.h"
#include "support/random_hand.h"
#include "support/random_scene.h"

namespace palpate::test {
namespace {

struct Tally {
  long ticks = 0;
  long inside = 0;     ///< proxy inside a wall
  long farther = 0;    ///< proxy farther away than that of the previous tick
  double worst = 0.0;  ///< [m]
  long left_region = 0;
};

/// A hand that jumps around the scene and rests in between; the ticks after a jump must finish what
/// one tick cannot.
void leap(std::uint64_t number, Tally& tally) {
  const RandomScene scene = randomScene(number);
  const ScenePtr compiled = scene.compiled();
  const testing::RegionTree tree(*compiled, compiled->startRegion());
  const auto start = roomyPoint(tree, number);
  if (!start) return;
  const auto renderer = makeRenderer(compiled);
  Random random(number + 17);
  Vec3 last = renderer->update({*start, Vec3(0.0)}).proxy;
  Vec3 p = *start;
  for (int i = 0; i < 60; ++i) {
    if (i % 4 != 3) {
      // The steps range from small ones to jumps across the scene.
      const double far = std::pow(10.0, random.uniform(-4.0, -1.3));
      p = last + far * random.direction();
    }
    const TickResult out = renderer->update({p, Vec3(0.0)});
    ++tally.ticks;
    const double on_surface = tree.onSurface();
    tally.inside += tree.value(out.proxy) < -2.0 * on_surface ? 1 : 0;
    const double more = glm::length(out.proxy - p) - glm::length(last - p);
    // The tolerance on a surface, and the rounding of lengths, are granted.
    if (more > 2.0 * on_surface + 1e-15) {
      ++tally.farther;
      tally.worst = std::max(tally.worst, more);
    }
    tally.left_region += out.region != compiled->startRegion() ? 1 : 0;
    last = out.proxy;
  }
}

TEST(Budget, NeverFartherFromTheHandAndNeverInside) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  Tally tally;
  for (std::uint64_t number = 1; number <= (slow ? 20'000U : 250U); ++number) leap(number, tally);
  EXPECT_GT(tally.ticks, 10'000);
  EXPECT_EQ(tally.inside, 0) << "of " << tally.ticks;
  EXPECT_EQ(tally.farther, 0) << "of " << tally.ticks << ", by up to " << tally.worst << " m";
  EXPECT_EQ(tally.left_region, 0);
}

}  // namespace
}  // namespace palpate::test
