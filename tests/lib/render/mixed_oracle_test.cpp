// Walls of different stiffness, pressed about as deep as they are large, checked by brute force:
// the minimum of the energy that their springs and the stop can store, over all places of the point
// between them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "lib/render/drive.h"
#include "palpate/render/tick_state.h"
#include "support/random_hand.h"

namespace palpate::test {
namespace {

struct Bar {
  Vec3 center;       // [m]
  double radius;     // [m]
  double stiffness;  // [N/m]
};

const std::array<Bar, 2> kBars{Bar{mm(-1.4, 0, 0), 2.0e-3, 500.0},
                               Bar{mm(1.1, 0, 0), 1.6e-3, 3000.0}};
constexpr double kStop = 1.05 * 3000.0;  // [N/m]

ScenePtr bars() {
  return sceneOf(R"(
palpate: 1
length: mm
materials: {soft: {stiffness: 500 N/m}, hard: {stiffness: 3000 N/m}}
layers:
  - {name: a, inside: {cylinder: {center: [-1.4, 0, 0], axis: [0, 1, 0], radius: 2, height: 60}}, wall: soft}
  - {name: b, inside: {cylinder: {center: [1.1, 0, 0], axis: [0, 1, 0], radius: 1.6, height: 60}}, wall: hard}
)");
}

/// A bar along y as it is felt with the proxy at `proxy`, the hand `deep` [m] away: it is blended
/// with its tangent plane there by a share. So its section is a conic about its center, with the
/// radius R / ((1 - share) + share cos(angle to the normal)).
class FeltBar {
 public:
  FeltBar(const Bar& bar, const Vec3& proxy, double deep)
      : bar_(bar), up_(glm::normalize(Vec3(proxy.x - bar.center.x, 0.0, proxy.z - bar.center.z))) {
    const double q = std::clamp((deep - 0.25 * bar.radius) / (0.75 * bar.radius), 0.0, 1.0);
    share_ = q * q * (3.0 - 2.0 * q);
  }

  /// [J] The energy at `p` [m] of its spring in series with the stop.
  [[nodiscard]] double stored(const Vec3& p) const {
    const double way = depth(p);
    return 0.5 * bar_.stiffness * kStop / (kStop - bar_.stiffness) * way * way;
  }

 private:
  /// [m] Distance from `p` to the nearest place outside: searched in all directions, then refined.
  [[nodiscard]] double depth(const Vec3& p) const {
    const Vec3 off(p.x - bar_.center.x, 0.0, p.z - bar_.center.z);
    const double y = glm::dot(off, up_);
    const double x = std::sqrt(std::max(0.0, glm::dot(off, off) - y * y));
    const auto radiusAt = [&](double angle) {
      const double by = (1.0 - share_) + share_ * std::cos(angle);
      return by > 1e-9 ? bar_.radius / by : kInfinity;
    };
    const double own = std::hypot(x, y);
    if (own >= radiusAt(std::atan2(x, y))) return 0.0;
    const auto away = [&](double angle) {
      const double r = radiusAt(angle);
      return r < kInfinity ? std::hypot(r * std::sin(angle) - x, r * std::cos(angle) - y)
                           : kInfinity;
    };
    constexpr int kLooks = 48;
    const double step = 2.0 * std::numbers::pi / kLooks;
    double best = 0.0;
    for (int i = 1; i < kLooks; ++i) {
      if (away(i * step) < away(best)) best = i * step;
    }
    double low = best - step;
    double high = best + step;
    for (int i = 0; i < 40; ++i) {
      const double a = low + (high - low) / 3.0;
      const double b = high - (high - low) / 3.0;
      (away(a) < away(b) ? high : low) = away(a) < away(b) ? b : a;
    }
    return away(0.5 * (low + high));
  }

  Bar bar_;
  Vec3 up_;
  double share_ = 0.0;
};

struct Rest {
  Vec3 place;     // [m]
  double energy;  // [J]
};

/// All local minima of the stored energy around `proxy`, found by descents from 25 places.
std::vector<Rest> restsOf(const Vec3& proxy, const Vec3& hand) {
  const double deep = glm::length(hand - proxy);
  const std::array<FeltBar, 2> felt{FeltBar(kBars[0], proxy, deep), FeltBar(kBars[1], proxy, deep)};
  const auto energy = [&](const Vec3& p) {
    return 0.5 * kStop * glm::dot(p - hand, p - hand) + felt[0].stored(p) + felt[1].stored(p);
  };
  std::vector<Rest> out;
  for (int i = 0; i < 25; ++i) {
    const Vec3 grid(i % 5 - 2, 0, i / 5 - 2);
    Rest rest{0.5 * (proxy + hand) + 0.35 * deep * grid, 0.0};
    rest.energy = energy(rest.place);
    for (double step = 0.2 * deep; step > 1e-9;) {
      bool is_lower = false;
      for (int axis = 0; axis < 4; ++axis) {
        Vec3 next = rest.place;
        next[axis / 2 * 2] += axis % 2 == 0 ? step : -step;
        const double there = energy(next);
        if (!(there < rest.energy)) continue;
        is_lower = true;
        rest = {next, there};
      }
      step *= is_lower ? 1.5 : 0.5;
    }
    // In a valley a descent along the axes ends slightly before the minimum.
    const bool is_known = std::any_of(out.begin(), out.end(), [&](const Rest& each) {
      return glm::length(each.place - rest.place) < 1e-2 * deep;
    });
    if (!is_known) out.push_back(rest);
  }
  std::sort(out.begin(), out.end(),
            [](const Rest& a, const Rest& b) { return a.energy < b.energy; });
  return out;
}

TEST(MixedOracle, WhatIsStoredIsTheLeastThatCanBeHoweverDeepThePressIs) {
  Drive drive(bars());
  Random random(7);
  int several = 0;
  int deep = 0;
  constexpr int kHands = 24;
  for (int i = 0; i < kHands; ++i) {
    (void)drive.walk(mm(-0.1, 0, 6), 1e-3);
    (void)drive.walk(mm(-0.1, 0, 1.4), 0.2e-3);
    const Vec3 hand =
        mm(-0.1, 0, 1.4) + random.uniform(0.2e-3, 2.4e-3) *
                               glm::normalize(random.in({mm(-0.5, 0, -1), mm(0.5, 0, -0.6)}));
    const TickResult out = drive.walk(hand, 20e-6);
    ASSERT_TRUE(out.contact) << i;
    const std::vector<Rest> rests = restsOf(out.proxy, hand);
    const double stored = TickState::of(drive.renderer().state()).source.stored.energy;
    several += rests.size() > 1 ? 1 : 0;
    deep += glm::length(hand - out.proxy) > kBars[1].radius ? 1 : 0;
    EXPECT_NEAR(stored, rests[0].energy, 1e-5 * rests[0].energy) << i << ", " << rests.size();
  }
  std::printf("  %d of %d hands deeper than a bar's radius, %d with several places of rest\n", deep,
              kHands, several);
  EXPECT_GT(deep, 3);
}

/// Along the soft bar the planes turn with the proxy, and at the crease the proxy stops: deep in a
/// bar neither the force nor the stored energy may jump there.
TEST(MixedOracle, WhereACreaseIsReachedDeepNothingStepsAndNothingIsGiven) {
  Drive drive(bars());
  (void)drive.walk(mm(-1.4, 0, 4), 1e-3);
  (void)drive.walk(mm(-1.4, 0, 1), 20e-6);
  // The place where the two circles intersect.
  const double x = 0.138e-3;
  const Vec3 edge(x, 0.0, std::sqrt(4e-6 - (x + 1.4e-3) * (x + 1.4e-3)));
  constexpr double kStep = 0.25e-6;
  double step = 0.0;
  double jump = 0.0;
  double slope = 0.0;
  TickResult last = drive.last();
  double stored = TickState::of(drive.renderer().state()).source.stored.energy;
  double work = 0.0;
  const auto go = [&](const Vec3& to) {
    const Vec3 from = drive.hip();
    const TickResult now = drive.to(to);
    const double done = 0.5 * glm::dot(now.force + last.force, to - from);
    work += done;
    const double there = TickState::of(drive.renderer().state()).source.stored.energy;
    jump = std::max(jump, std::fabs(there - stored + done));
    const double change = glm::length(now.force - last.force);
    if (glm::length(now.proxy - edge) < 1e-8 && glm::length(last.proxy - edge) > 1e-8)
      step = change;
    slope = std::max(slope, glm::length(now.force));
    last = now;
    stored = there;
  };
  for (double at = -1.4e-3; at < 0.8e-3; at += kStep) go({at, 0.0, 1e-3});
  for (double at = 0.8e-3; at > -1.4e-3; at -= kStep) go({at, 0.0, 1e-3});
  std::printf("  %.3g of %.3g N; what is stored steps by %.3g J at most, %.3g J there and back\n",
              step, slope, jump, work);
  EXPECT_GT(step, 0.0) << "the crease was not reached";
  EXPECT_LE(step, 4.0 * 3000.0 * kStep);
  EXPECT_LE(jump, 1e-10);
  EXPECT_LE(work, 1e-9);
}

}  // namespace
}  // namespace palpate::test
