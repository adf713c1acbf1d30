// A hand that releases the world by the clutch and takes hold of it elsewhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"

namespace palpate::devices {
namespace {

constexpr double kTick = 1e-3;  // [s]

/// A wall below z = 0 with friction, which breaks away without a jump, and damping, under a viscous
/// bath.
ScenePtr wallUnderOil() {
  return compile(parseScene(R"(
palpate: 1
length: mm
device: {scale: 2, clutch: true}
materials:
  wall: {stiffness: 800 N/m, damping: 1 N.s/m, friction: {static: 0.2, kinetic: 0.2}}
  oil: {viscosity: 3 N.s/m}
layers:
  - {name: bath, inside: {box: {center: [0, 0, 0], size: [400, 400, 400]}}, content: oil, wall: absent}
  - {name: floor, inside: {box: {center: [0, 0, -50], size: [300, 300, 100]}}, wall: wall}
)",
                            "clutch.yaml"));
}

/// Feeds readings to a session of that scene, one each millisecond.
class Hand {
 public:
  explicit Hand(const ScenePtr& scene) : session_(scene) {}
  SessionTick to(const Vec3& device, bool held) {
    return session_.step({.time = kTick * n_++, .position = device, .buttons = held ? 1U : 0U},
                         DeviceFrame::kDevice);
  }

 private:
  Session session_;
  int n_ = 0;
};

/// Presses and strokes: at most 1.8 mm deep, at up to 37 mm/s and 0.23 m/s^2. [m, device]
Vec3 stroke(int n) {
  const double t = n * kTick;
  return {0.006 * std::sin(6.0 * t), 0.002 * t, -0.0009 * (1.0 - std::cos(9.0 * t))};
}

TEST(Clutch, NothingJumpsWhereAMovingHandEngagesOrLetsGo) {
  const ScenePtr scene = wallUnderOil();
  for (const int engaged : {301, 350, 422}) {
    for (const int for_ticks : {1, 7, 30, 200}) {
      Hand with(scene);
      Hand without(scene);
      SessionTick last;
      double largest = 0.0;
      for (int n = 0; n < engaged + for_ticks + 200; ++n) {
        const bool held = n >= engaged && n < engaged + for_ticks;
        const SessionTick tick = with.to(stroke(n), held);
        // The reading that engages the clutch is felt as if there were none.
        if (n <= engaged) {
          const SessionTick free = without.to(stroke(n), false);
          EXPECT_LT(glm::length(tick.force - free.force), 1e-12);
          EXPECT_LT(glm::length(tick.hip.position - free.hip.position), 1e-12);
        }
        if (n > engaged && n <= engaged + for_ticks) {
          EXPECT_LT(glm::length(tick.hip.position - last.hip.position), 1e-12) << n;
        }
        if (n > 250) largest = std::max(largest, glm::length(tick.force));
        if (n > engaged) {
          // In a tick the force changes at most by the sum of three parts: 1.5 times itself per
          // kFade; drag and damping, 4 N s/m, times the world's 0.46 m/s^2 plus the fade of its
          // 0.08 m/s; and the springs, 800 N/m, times that speed. Without the fades drag alone
          // would jump by 0.3 N.
          const double fade = 1.5 * kTick / Clutch::kFade;
          const double most =
              fade * largest + 4.0 * (0.46 * kTick + fade * 0.08) + 800.0 * 0.08 * kTick;
          EXPECT_LT(most, 0.2);
          EXPECT_LT(glm::length(tick.force - last.force), most) << n;
        }
        last = tick;
      }
      EXPECT_GT(largest, 0.5);
    }
  }
}

TEST(Clutch, AHandThatIsHeldForLongLetsGoOfNothingAndTakesHoldOfTheSame) {
  const ScenePtr scene = wallUnderOil();
  Hand hand(scene);
  for (int n = 0; n <= 400; ++n) (void)hand.to(stroke(n), false);
  // The hand rests, so that only springs and friction are felt.
  Vec3 device = stroke(400);
  SessionTick before;
  for (int n = 0; n < 100; ++n) before = hand.to(device, false);
  ASSERT_GT(glm::length(before.force), 0.5);
  double last = glm::length(before.force);
  SessionTick tick;
  for (int n = 0; n < 200; ++n) {
    tick = hand.to(device, true);
    device += Vec3(2e-5, -1e-5, 5e-5);
    EXPECT_LT(glm::length(tick.hip.position - before.hip.position), 1e-15);
    EXPECT_EQ(tick.hip.velocity, Vec3(0.0));
    EXPECT_LE(glm::length(tick.force), last + 1e-12);
    last = glm::length(tick.force);
  }
  EXPECT_EQ(last, 0.0);
  const SessionTick let_go = hand.to(device, false);
  EXPECT_LT(glm::length(let_go.hip.position - before.hip.position), 1e-12);
  EXPECT_LT(glm::length(let_go.force - tick.force), 1e-12);
  for (int n = 0; n < 200; ++n) tick = hand.to(device, false);
  EXPECT_LT(glm::length(tick.force - before.force), 1e-9);
  // From there the probe moves by the hand's displacement times the scale.
  tick = hand.to(device + Vec3(0.0, 0.0, 1e-4), false);
  EXPECT_LT(glm::length(tick.hip.position - before.hip.position - Vec3(0.0, 0.0, 2e-4)), 1e-15);
}

TEST(Clutch, AReadingThatNoHandCanGiveNeitherEngagesNorLetsGo) {
  const ScenePtr scene = wallUnderOil();
  for (const double far : {1.01e4, 2e4, 1e300}) {
    for (const int when : {500, 600}) {
      Hand hand(scene);
      Hand other(scene);
      SessionTick tick;
      SessionTick wanted;
      for (int n = 0; n < 900; ++n) {
        const bool held = n >= 500 && n < 600;
        const Vec3 rests = stroke(std::min(n, 400));
        tick = hand.to(n == when ? Vec3(0.0, 0.0, far) : rests, held);
        wanted = other.to(rests, held);
        EXPECT_LT(glm::length(tick.force), 3.0);
      }
      EXPECT_GT(glm::length(wanted.force), 0.5);
      EXPECT_LT(glm::length(tick.hip.position - wanted.hip.position), 1e-15);
      EXPECT_EQ(tick.hip.velocity, Vec3(0.0));
      EXPECT_LT(glm::length(tick.force - wanted.force), 1e-9) << far << " at " << when;
    }
  }
}

}  // namespace
}  // namespace palpate::devices
