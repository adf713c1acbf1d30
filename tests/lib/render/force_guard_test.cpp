#include "palpate/render/force_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "palpate/fields/primitives.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {
namespace {

constexpr double kTick = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Vec3 push(double newton) { return {newton, 0.0, 0.0}; }

TEST(ForceGuard, AForceThatTurnsRoundGoesToZeroAndGrowsByTheSlewRate) {
  ForceGuard guard({.max_growth = 100.0});  // 0.1 N a tick
  for (int i = 0; i < 100; ++i) (void)guard.apply(push(2.0), kTick);
  ASSERT_EQ(guard.apply(push(2.0), kTick), push(2.0));
  // Without the limit on the change of the vector, all of -2 N would come in this tick.
  EXPECT_NEAR(guard.apply(push(-2.0), kTick).x, -0.1, 1e-15);
  for (int i = 2; i <= 20; ++i) {
    EXPECT_NEAR(guard.apply(push(-2.0), kTick).x, -0.1 * i, 1e-13);
  }
}

TEST(ForceGuard, AForceThatTurnsSidewaysGrowsThereByTheSlewRate) {
  ForceGuard guard({.max_growth = 100.0});
  for (int i = 0; i < 21; ++i) (void)guard.apply(push(2.0), kTick);
  EXPECT_NEAR(guard.apply({0.0, 2.0, 0.0}, kTick).y, 0.1, 1e-15);
}

TEST(ForceGuard, LettingGoIsNeverDelayed) {
  ForceGuard guard({.max_growth = 100.0});
  for (int i = 0; i < 21; ++i) (void)guard.apply(push(2.0), kTick);
  EXPECT_EQ(guard.apply(push(0.3), kTick), push(0.3));
  EXPECT_EQ(guard.apply(push(0.0), kTick), push(0.0));
  EXPECT_NEAR(guard.apply(push(2.0), kTick).x, 0.1, 1e-15);
}

TEST(ForceGuard, AGapBringsNoMoreThanANominalPeriod) {
  ForceGuard guard({.max_growth = 100.0});
  (void)guard.apply(push(0.0), kTick);
  EXPECT_NEAR(guard.apply(push(15.0), 0.15).x, 0.1, 1e-15);  // 15 N would come at once
  ForceGuard slow({.max_growth = 100.0, .period = 0.01});
  EXPECT_NEAR(slow.apply(push(15.0), 0.15).x, 1.0, 1e-14);
  EXPECT_NEAR(slow.apply(push(15.0), 1e-3).x, 1.1, 1e-14) << "an early tick counts as it is";
}

TEST(ForceGuard, TheRampAndTheSlewRateDoNotFeedOnEachOther) {
  // 2 N, with a ramp of 1 s: 1 N is due half-way. The slew rate allows 50 N/s, so it never limits a
  // rise of 2 N/s.
  ForceGuard guard({.max_growth = 50.0, .ramp = 1.0});
  double force = 0.0;
  for (int i = 0; i <= 500; ++i) force = guard.apply(push(2.0), kTick).x;
  EXPECT_NEAR(force, 1.0, 1e-12);  // rounding of 501 additions of doubles
  for (int i = 501; i <= 1001; ++i) force = guard.apply(push(2.0), kTick).x;
  EXPECT_EQ(force, 2.0);
  // The ramp does not make a slow rise slower: 1 N/s from the start.
  ForceGuard slow({.max_growth = 1.0, .ramp = 0.1});
  for (int i = 0; i <= 500; ++i) force = slow.apply(push(2.0), kTick).x;
  EXPECT_NEAR(force, 0.5, 2e-3);  // within two ticks: the ramp's first force is zero
}

TEST(ForceGuard, AGapDoesNotSkipTheRamp) {
  ForceGuard guard({.ramp = 0.1});
  (void)guard.apply(push(2.0), kTick);
  (void)guard.apply(push(2.0), 5.0);
  EXPECT_NEAR(guard.apply(push(2.0), kTick).x, 2.0 * 0.02, 1e-15);
}

TEST(ForceGuard, ResetForgetsTheLastForceAndBeginsTheRampAgain) {
  ForceGuard guard({.max_growth = 100.0, .ramp = 0.01});
  for (int i = 0; i < 50; ++i) (void)guard.apply(push(2.0), kTick);
  guard.reset();
  EXPECT_EQ(guard.apply(push(2.0), kTick), push(0.0));
  EXPECT_NEAR(guard.apply(push(2.0), kTick).x, 0.1, 1e-15);
  ForceGuard fresh({.max_growth = 100.0, .ramp = 0.01});
  guard.reset();
  for (int i = 0; i < 30; ++i) {
    const Vec3 wanted(0.1 * i, std::sin(i), 0.5);
    EXPECT_EQ(guard.apply(wanted, kTick), fresh.apply(wanted, kTick));
  }
}

TEST(ForceGuard, AForceThatIsNotFiniteBecomesZeroAndGrowthStartsFromThere) {
  for (const Vec3& bad : {Vec3(kNan, 0.0, 0.0), Vec3(0.0, kInfinity, 0.0), Vec3(1e200, 0.0, 0.0)}) {
    ForceGuard guard({.max_force = 5.0, .max_growth = 100.0});
    for (int i = 0; i < 60; ++i) (void)guard.apply(push(5.0), kTick);
    EXPECT_EQ(guard.apply(bad, kTick), push(0.0));
    EXPECT_NEAR(guard.apply(push(5.0), kTick).x, 0.1, 1e-15);
  }
}

TEST(ForceGuard, ATimeThatIsNotFiniteOrBackwardsLetsNothingGrow) {
  for (const double bad : {kNan, kInfinity, -kInfinity, -1.0, 0.0}) {
    ForceGuard guard({.max_growth = 100.0, .ramp = 0.0});
    (void)guard.apply(push(5.0), kTick);
    EXPECT_NEAR(guard.apply(push(5.0), bad).x, 0.1, 1e-15) << bad;
    EXPECT_EQ(guard.apply(push(0.05), bad), push(0.05)) << "letting go needs no time";
    EXPECT_NEAR(guard.apply(push(5.0), kTick).x, 0.15, 1e-15) << "and what follows is sound";
  }
}

TEST(ForceGuard, ALimitThatIsNoNumberOrBelowZeroPermitsNothing) {
  for (const double bad : {kNan, -1.0, -kInfinity, 0.0}) {
    ForceGuard clamped({.max_force = bad});
    EXPECT_EQ(clamped.apply(push(3.0), kTick), push(0.0)) << bad;
    ForceGuard slewed({.max_growth = bad});
    EXPECT_EQ(slewed.apply(push(3.0), kTick), push(0.0)) << bad;
    ForceGuard stopped({.max_growth = 100.0, .period = bad});
    EXPECT_EQ(stopped.apply(push(3.0), kTick), push(0.0)) << bad;
  }
  ForceGuard ramped({.ramp = kNan});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(ramped.apply(push(3.0), kTick), push(0.0));
}

/// A ball of 10 mm and 1000 N/m around the origin, felt 4 mm deep.
double forceIn(const ForceRequest& of_scene, const ForceLimits& asked, RendererKind kind) {
  SceneDescription description;
  LayerDescription ball;
  ball.name = "ball";
  ball.inside = std::make_shared<FieldSource>(sphere({0.0, 0.0, 0.0}, 0.01));
  description.layers = {ball};
  description.force = of_scene;
  const std::unique_ptr<HapticRenderer> renderer =
      makeRenderer(compile(description), {.kind = kind, .limits = asked});
  double force = 0.0;
  for (int tick = 0; tick <= 50; ++tick) {
    const double x = 0.011 - 1e-4 * tick;
    force = glm::length(renderer->update({.position = {x, 0.0, 0.0}, .dt = kTick}).force);
  }
  return force;
}

TEST(ForceGuard, TheLimitsOfASceneHoldWhereTheSettingsGiveNone) {
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    EXPECT_NEAR(forceIn({}, {}, kind), 4.0, 1e-9);
    EXPECT_NEAR(forceIn({.max = 1.5}, {}, kind), 1.5, 1e-12);
    EXPECT_NEAR(forceIn({.max = 1.5}, {.max_force = 2.5}, kind), 2.5, 1e-12);
    // 40 ticks in contact, of 0.01 N each; before them a tick in which the hand is on the surface.
    // There the paper's renderer finds the contact point within its epsilon of 1 um: 1 mN.
    EXPECT_NEAR(forceIn({.slew = 10.0}, {}, kind), 0.4, 1e-3);
    EXPECT_NEAR(forceIn({.slew = 10.0}, {.max_growth = 20.0}, kind), 0.8, 1e-3);
    // After 50 of 100 ticks the ramp is half over.
    EXPECT_NEAR(forceIn({.ramp = 0.1}, {}, kind), 2.0, 1e-9);
    EXPECT_NEAR(forceIn({.ramp = 0.1}, {.ramp = 0.2}, kind), 1.0, 1e-9);
  }
}

/// The limits in another formulation: a force may be sent if it is not longer than the maximum and
/// if some share of the last force is within reach of it. Shares are tried one after the other.
struct Model {
  ForceLimits limits;
  Vec3 last{0.0};
  double age = 0.0;

  [[nodiscard]] double reach(double dt) const {
    if (!(dt > 0.0) || std::isinf(dt)) return 0.0;
    return limits.max_growth * (dt < limits.period ? dt : limits.period);
  }
  [[nodiscard]] Vec3 wanted(Vec3 force) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(force[axis])) return Vec3(0.0);
    }
    const double length = std::hypot(force.x, force.y, force.z);
    if (length > 1e150) return Vec3(0.0);
    if (length > limits.max_force) force = force * limits.max_force / length;
    return limits.ramp > 0.0 ? force * std::min(1.0, age / limits.ramp) : force;
  }
  /// Distance from `force` to the nearest multiple (0 to 1) of the last force.
  [[nodiscard]] double away(const Vec3& force) const {
    double nearest = kInfinity;
    for (int i = 0; i <= 2000; ++i) {
      const Vec3 d = force - last * (i / 2000.0);
      nearest = std::min(nearest, std::hypot(d.x, d.y, d.z));
    }
    return nearest;
  }
  void sent(const Vec3& force, double dt) {
    last = force;
    if (dt > 0.0 && std::isfinite(dt)) age += std::min(dt, limits.period);
  }
};

TEST(ForceGuard, KeepsItsWordOnRandomSequences) {
  std::mt19937_64 random(17);
  const auto uniform = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  };
  int held_back = 0;
  for (int sequence = 0; sequence < 60; ++sequence) {
    ForceLimits limits;
    if (sequence % 3 != 0) limits.max_force = uniform(0.5, 6.0);
    limits.max_growth = uniform(20.0, 2000.0);
    if (sequence % 2 == 0) limits.ramp = uniform(0.01, 0.2);
    limits.period = sequence % 5 == 0 ? 1e-2 : kTick;
    ForceGuard guard(limits);
    Model model{limits};
    Vec3 force(0.0);
    for (int tick = 0; tick < 200; ++tick) {
      const double what = uniform(0.0, 1.0);
      if (what < 0.1) {
        force = -force;
      } else if (what < 0.2) {
        force = {uniform(-8.0, 8.0), uniform(-8.0, 8.0), uniform(-8.0, 8.0)};
      } else if (what < 0.25) {
        force = Vec3(0.0);
      } else {
        force += Vec3(uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2));
      }
      Vec3 asked = force;
      if (what > 0.98) asked.y = what > 0.99 ? kNan : kInfinity;
      double dt = limits.period;
      const double when = uniform(0.0, 1.0);
      if (when < 0.05) dt = uniform(0.0, 2.0);
      if (when > 0.97) dt = when > 0.985 ? kNan : -1.0;
      if (when > 0.995) {
        guard.reset();
        model = Model{limits};
      }

      const Vec3 due = model.wanted(asked);
      const double reach = model.reach(dt);
      const Vec3 sent = guard.apply(asked, dt);
      ASSERT_TRUE(isFinite(sent));
      ASSERT_LE(glm::length(sent), limits.max_force * (1.0 + 1e-12));
      // Shares are 1/2000 apart: half of that, of at most 14 N.
      constexpr double kGrain = 14.0 / 4000.0;
      ASSERT_LE(model.away(sent), reach + kGrain) << sequence << " " << tick;
      if (model.away(due) <= reach - kGrain) {
        ASSERT_LE(glm::length(sent - due), 1e-12) << "held back without need";
      } else if (reach > 0.0 && sent != due) {
        ++held_back;
        // No permitted force is nearer to the one that is due.
        const double missed = glm::length(due - sent);
        for (int i = 0; i < 40; ++i) {
          Vec3 way(uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0));
          way *= reach * uniform(0.0, 1.0) / std::max(glm::length(way), 1e-9);
          const Vec3 other = model.last * uniform(0.0, 1.0) + way;
          ASSERT_GE(glm::length(due - other), missed * (1.0 - 1e-9) - 1e-12);
        }
      }
      model.sent(sent, dt);
    }
  }
  EXPECT_GT(held_back, 1000) << "the sequences ask for what is not allowed";
}

}  // namespace
}  // namespace palpate
