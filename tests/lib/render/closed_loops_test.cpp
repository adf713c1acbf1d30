// Closed loops of the hand over random solids: with one stiffness and no friction they give it no
// energy.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "lib/render/drive.h"
#include "support/random_hand.h"
#include "support/random_scene.h"

namespace palpate::test {
namespace {

constexpr double kStiffness = 1000.0;  // [N/m]

/// A smooth closed path around a point.
class Loop {
 public:
  Loop(Random& random, const Vec3& center) : center_(center) {
    for (Vec3& each : waves_) each = random.uniform(0.3e-3, 1.5e-3) * random.direction();
  }
  [[nodiscard]] Vec3 at(double share) const {
    const double turn = 2.0 * std::numbers::pi * share;
    return center_ + std::cos(turn) * waves_[0] + std::sin(turn) * waves_[1] +
           std::cos(2.0 * turn) * waves_[2] + std::sin(2.0 * turn) * waves_[3];
  }

 private:
  Vec3 center_;
  std::array<Vec3, 4> waves_{};
};

struct Lap {
  /// [J] to the hand, beyond the energy that the wall stored at the lap's beginning and lost by its
  /// end
  double given = 0.0;
  int leaps = 0;  ///< jumps of the proxy off a wall, where energy is lost
  long contacts = 0;
};

/// The second lap; the first one brings the proxy to its place on the loop.
Lap lapOf(const ScenePtr& scene, const Vec3& start, const Loop& loop, int steps) {
  const auto renderer = makeRenderer(scene);
  const auto tick = [&](const Vec3& p) { return renderer->update({p, Vec3(0.0)}); };
  (void)tick(start);
  constexpr int kWayIn = 400;
  for (int i = 1; i <= kWayIn; ++i) (void)tick(glm::mix(start, loop.at(0.0), 1.0 * i / kWayIn));
  for (int i = 0; i < steps; ++i) (void)tick(loop.at(static_cast<double>(i) / steps));
  Lap out;
  Vec3 last = loop.at(0.0);
  TickResult before = tick(last);
  for (int i = 1; i <= steps; ++i) {
    const Vec3 p = loop.at(static_cast<double>(i) / steps);
    const TickResult now = tick(p);
    const Vec3 step = p - last;
    const auto stored = [&](const TickResult& at, const Vec3& hip) {
      const Vec3 stretch = at.proxy - hip;
      return 0.5 * kStiffness * glm::dot(stretch, stretch);
    };
    const double change = stored(now, p) - stored(before, last);
    const bool is_leap = glm::length(now.proxy - before.proxy) > 1e3 * glm::length(step);
    // The proxy left a wall somewhere during the step: until then the force was the previous one.
    const double work = is_leap ? std::min(glm::dot(before.force, step), -change)
                                : 0.5 * glm::dot(before.force + now.force, step);
    out.leaps += is_leap ? 1 : 0;
    out.given += work + change;
    out.contacts += now.contact ? 1 : 0;
    before = now;
    last = p;
  }
  return out;
}

TEST(ClosedLoops, OverRandomSolidsGiveNoEnergy) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int wanted = slow ? 3000 : 60;
  int loops = 0;
  int giving = 0;
  double most = 0.0;
  long contacts = 0;
  std::string list;
  for (std::uint64_t number = 1; loops < wanted; ++number) {
    RandomSceneOptions options;
    options.black_box_creases = false;
    const RandomScene scene = randomScene(number, options);
    const ScenePtr compiled = scene.compiled();
    const testing::RegionTree tree(*compiled, compiled->startRegion());
    const auto start = roomyPoint(tree, number);
    if (!start) continue;
    // Loops around the place to which a pressing hand brought the proxy: often where walls meet.
    Random random(number + 5);
    const auto renderer = makeRenderer(compiled);
    RandomHand hand(number, *start);
    Vec3 center = *start;
    for (int i = 0; i < 300; ++i) center = renderer->update({hand.next(center, tree)}).proxy;
    const Loop loop(random, center);
    ++loops;
    Lap fine = lapOf(compiled, *start, loop, 2000);
    double given = kInfinity;
    // The error of the trapezoidal rule falls to a quarter when the step is halved, if the force is
    // smooth; if it has kinks, the step is halved further.
    for (int steps = 4000; steps <= 16'000 && std::min(given, fine.given) > 1e-9; steps *= 2) {
      const Lap coarse = std::exchange(fine, lapOf(compiled, *start, loop, steps));
      given = (4.0 * fine.given - coarse.given) / 3.0;
    }
    contacts += fine.contacts;
    if (std::min(given, fine.given) > 1e-9) {
      ++giving;
      if (giving <= 10) {
        list += " " + std::to_string(number) + ": " + std::to_string(1e9 * given) + " nJ";
      }
    }
    most = std::max(most, std::min(given, fine.given));
  }
  std::printf("%d loops, %ld ticks in contact: %d give energy, at most %.3g J;%s\n", loops,
              contacts, giving, most, list.c_str());
  EXPECT_EQ(giving, 0);
  EXPECT_GT(contacts, 500L * loops);
}

}  // namespace
}  // namespace palpate::test
