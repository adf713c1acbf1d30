// The container: whatever the hand does it never passes through the glass, and nothing chatters at
// the rim.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/shake.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 0.04;  // [m] of the bowl
constexpr double kBrim = 0.015;   // [m] height at which it is cut
const double kMouth = std::sqrt(kRadius * kRadius - kBrim * kBrim);

TEST(HardRim, TenMillionRandomTicksNeverPassTheWall) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  Bag bag{"container", sceneOf(containerText()), 1500.0};
  bag.ticks = slow ? 10'000'000 : 200'000;
  bag.rare = bag.ticks / 1000;
  shake(bag);
}

/// Whether the straight way from `a` to `b` goes through the mouth's disc.
bool crossesMouth(const Vec3& a, const Vec3& b) {
  if ((a.z > kBrim) == (b.z > kBrim)) return false;
  const Vec3 p = a + (kBrim - a.z) / (b.z - a.z) * (b - a);
  return std::hypot(p.x, p.y) < kMouth;
}

TEST(HardRim, FreeTicksChangeRegionOnlyThroughTheMouth) {
  // If the proxy is free before and after a tick, it went straight: an independent count of
  // crossings.
  const ScenePtr scene = sceneOf(containerText());
  Drive drive(scene);
  Hand hand(79, scene->bounds().grownBy(0.02));
  TickResult before = drive.renderer().update({hand.next(), Vec3(0.0)});
  Vec3 last(0.0);
  int judged = 0;
  const int ticks = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 2'000'000 : 200'000;
  for (int i = 0; i < ticks; ++i) {
    const Vec3 hip = hand.next();
    const TickResult out = drive.renderer().update({hip, Vec3(0.0)});
    const bool was_free = before.proxy == last && !before.contact;
    if (was_free && !out.contact && out.proxy == hip && out.event_count == 1 &&
        crossesMouth(last, hip)) {
      ASSERT_NE(out.region, before.region) << i;
      ++judged;
    }
    if (out.region != before.region) {
      ASSERT_GT(out.event_count, 0) << i;
      // The proxy passed through the plane of the brim, inside the rim or above it.
      ASSERT_TRUE(glm::length(out.proxy) < kRadius + 1e-9 || out.region == kOutside) << i;
    }
    if (out.region != kOutside) {
      ASSERT_LE(glm::length(out.proxy), kRadius + 1e-9) << i;
      ASSERT_LE(out.proxy.z, kBrim + 1e-9) << i;
    } else {
      ASSERT_TRUE(glm::length(out.proxy) > kRadius - 1e-9 || out.proxy.z > kBrim - 1e-9) << i;
    }
    before = out;
    last = hip;
  }
  EXPECT_GT(judged, 100);
}

/// Events of a hand that trembles by up to 0.1 mm around a point near the rim, and true crossings:
/// ticks in which the hand itself goes through the mouth, or over the sphere below the brim.
struct Chatter {
  int events = 0;
  int true_crossings = 0;
};
Chatter trembleAt(const Vec3& free, const Vec3& point, std::uint64_t seed) {
  Drive drive(sceneOf(containerText()));
  (void)drive.to(free);
  if (glm::length(free) < kRadius) {  // inside: through the mouth
    drive.renderer().reset();
    (void)drive.to(mm(0, 0, 30));
    (void)drive.walk(free);
  }
  (void)drive.events();
  (void)drive.to(free);
  Random random(seed);
  Chatter out;
  Vec3 last = point;
  (void)drive.walk(point);
  out.events += drive.events().empty() ? 0 : 1;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = point + random.uniform(0.0, 0.1e-3) * random.direction();
    const TickResult& tick = drive.to(p);
    out.events += tick.event_count;
    out.true_crossings += crossesMouth(last, p) ? 1 : 0;
    last = p;
  }
  return out;
}

TEST(HardRim, PressingAtItFromBothSidesDoesNotChatter) {
  const double rim = std::asin(kBrim / kRadius);
  std::uint64_t seed = 1;
  for (const bool inside : {false, true}) {
    for (const double depth : {0.3e-3, 1e-3, 4e-3}) {
      for (double off = -0.03; off <= 0.03; off += 0.0025) {
        const double angle = rim + off;
        const double rho = kRadius + (inside ? depth : -depth);
        const Vec3 u(std::cos(angle), 0, std::sin(angle));
        const Vec3 free = inside ? mm(20, 0, 0) : mm(60, 0, 0);
        const Chatter chatter = trembleAt(free, rho * u, seed++);
        EXPECT_LE(chatter.events, 1 + chatter.true_crossings)
            << (inside ? "inside" : "outside") << " depth " << depth << " off " << off;
      }
    }
  }
}

TEST(HardRim, SlidingAlongItFromBothSidesDoesNotChatter) {
  // The hand goes around the rim, weaving across it: there is at most one event for each time that
  // its way crosses the edge.
  const double rim = std::asin(kBrim / kRadius);
  for (const bool inside : {false, true}) {
    for (const double depth : {0.3e-3, 1e-3, 4e-3}) {
      Drive drive(sceneOf(containerText()));
      (void)drive.to(mm(0, 0, 60));
      (void)drive.walk(inside ? mm(20, 0, 0) : mm(60, 0, 60));
      if (!inside) (void)drive.walk(mm(60, 0, 0));
      (void)drive.events();
      const double rho = kRadius + (inside ? depth : -depth);
      Random random(12);
      int events = 0;
      int over = 0;
      double was = -1.0;
      Vec3 last(0.0);
      for (int i = 0; i < 20'000; ++i) {
        const double off = 0.1 * std::sin(0.003 * i);
        const double around = 0.001 * i;
        const Vec3 p = rho * Vec3(std::cos(rim + off) * std::cos(around),
                                  std::cos(rim + off) * std::sin(around), std::sin(rim + off)) +
                       random.uniform(0.0, 20e-6) * random.direction();
        events += drive.to(p).event_count;
        // The way crosses the edge when the hand's angle passes that of the rim, and when the hand
        // itself goes through the mouth.
        if (off * was < 0.0) ++over;
        if (i > 0 && crossesMouth(last, p)) ++over;
        was = off;
        last = p;
      }
      EXPECT_LE(events, over) << (inside ? "inside" : "outside") << " depth " << depth;
      EXPECT_GT(over, 15);
    }
  }
}

}  // namespace
}  // namespace palpate::test
