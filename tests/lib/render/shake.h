#pragma once
// A hand that does anything, and the properties that must hold whatever it does.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "lib/render/drive.h"
#include "support/field_contract.h"
#include "support/sanitized.h"

namespace palpate::test {

constexpr int kTicks = kSanitized ? 25'000 : 250'000;  // four scenes: a million

/// A hand that wanders, presses, flicks and jumps around a box, at 0.05 to 50 m/s.
class Hand {
 public:
  Hand(std::uint64_t seed, const Box3& box) : random_(seed), box_(box), at_(random_.in(box)) {}

  Vec3 next() {
    if (--left_ <= 0) {
      left_ = static_cast<int>(random_.uniform(1, 80));
      speed_ = std::pow(10.0, random_.uniform(-1.3, 1.7)) * 1e-3;  // [m] in a tick
      goal_ = random_.in(box_);
      kind_ = static_cast<int>(random_.uniform(0, 4));
    }
    if (kind_ == 0) return at_;                                 // rests
    if (kind_ == 1) return at_ = random_.in(box_);              // jumps
    if (kind_ == 2) at_ += 0.3 * speed_ * random_.direction();  // trembles
    const Vec3 way = goal_ - at_;
    const double length = glm::length(way);
    if (length > 0.0) at_ += way * std::min(1.0, speed_ / length);
    return at_;
  }

 private:
  Random random_;
  Box3 box_;
  Vec3 at_;
  Vec3 goal_{0.0};
  double speed_ = 1e-3;
  int left_ = 0;
  int kind_ = 3;
};

/// True if a point within `reach` of p belongs to `region`: at a wall the side is remembered, not
/// measured.
inline bool isAt(const Scene& scene, RegionId region, const Vec3& p, double reach) {
  if (scene.regionAt(p) == region) return true;
  for (int i = 0; i < 27; ++i) {
    const Vec3 u(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (scene.regionAt(p + reach * u) == region) return true;
  }
  return false;
}

/// Whether the events explain the way from one region to the other, if no wall is absent.
inline bool isExplained(const Scene& scene, RegionId from, const TickResult& out) {
  std::vector<RegionId> now{from};
  for (int i = 0; i < out.event_count; ++i) {
    const Port& port = scene.ports()[out.events[static_cast<std::size_t>(i)]];
    std::vector<RegionId> next;
    for (std::size_t r = 0; r < scene.regions().size(); ++r) {
      const auto region = static_cast<RegionId>(r);
      if (std::any_of(now.begin(), now.end(), [&](RegionId a) { return port.leads(a, region); })) {
        next.push_back(region);
      }
    }
    now = next;
  }
  return std::find(now.begin(), now.end(), out.region) != now.end();
}

struct Bag {
  const char* name;
  ScenePtr scene;
  double stiffness;  ///< [N/m] stiffness of all walls, which have no friction and no damping
  int rare = kTicks / 1000;  ///< ticks in which the proxy may still be on its way
  int ticks = kTicks;
  /// [N] largest force at rest outside, if every wall ruptures above a force: the sum of two of
  /// them
  double most_outside = std::numeric_limits<double>::infinity();
};

inline void shake(const Bag& bag) {
  const Scene& scene = *bag.scene;
  Drive drive(bag.scene);
  Hand hand(77, scene.bounds().grownBy(0.02));
  RegionId region = scene.startRegion();
  int events = 0;
  int contacts = 0;
  int unsettled = 0;
  for (int i = 0; i < bag.ticks; ++i) {
    const Vec3 hip = hand.next();
    // The velocity is zero, so that drag has no part in the force.
    const TickResult out = drive.renderer().update({hip, Vec3(0.0)});
    SCOPED_TRACE(::testing::Message() << bag.name << " tick " << i);
    ASSERT_TRUE(isFinite(out.force));
    ASSERT_TRUE(isAt(scene, out.region, out.proxy, 2e-8))
        << "says " << out.region << ", is in " << scene.regionAt(out.proxy);
    ASSERT_TRUE(isExplained(scene, region, out)) << region << " to " << out.region;
    region = out.region;
    events += out.event_count;
    contacts += out.contact ? 1 : 0;
    const Vec3 spring = bag.stiffness * (out.proxy - hip);
    if (!out.contact) {
      ASSERT_EQ(out.force, Vec3(0.0));
    } else {
      ASSERT_LE(glm::length(out.force), glm::length(spring) * (1.0 + 1e-6) + 1e-6);
    }
    if (!out.settled) {
      ++unsettled;
    } else if (out.region == kOutside) {
      ASSERT_LE(glm::length(out.force), bag.most_outside);
    }
  }
  EXPECT_GT(events, bag.ticks / 500) << bag.name;
  EXPECT_GT(contacts, bag.ticks / 10) << bag.name;  // enough to be meaningful
  EXPECT_LE(unsettled, bag.rare) << bag.name;
}

}  // namespace palpate::test
