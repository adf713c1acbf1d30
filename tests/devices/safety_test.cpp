// The limits between a force and a hand, and the states of a device.

#include "palpate/devices/safety.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kTurn = 1'000'000;       // [ns]
constexpr std::int64_t kWatchdog = 20'000'000;  // [ns]

DeviceState at(const Vec3& position, bool is_homed = true) {
  DeviceState out;
  out.position = position;
  out.is_homed = is_homed;
  return out;
}

/// A device that was opened, homed, and has a believed position at `time` [ns].
Safety opened(const SafetyLimits& limits, double max_force = 10.0) {
  Safety safety(limits, max_force, kWatchdog, 0, kTurn);
  safety.open(0);
  (void)safety.read(kTurn, DeviceStatus::kOk, at(Vec3(0.0)));
  return safety;
}

/// The table, derived again from the meaning of each state.
SafetyState meant(SafetyState state, SafetyEvent event) {
  const bool is_open = state != SafetyState::kClosed;
  const bool is_fault = state == SafetyState::kFault;
  const bool has_origin = state == SafetyState::kIdle || permitsForce(state);
  switch (event) {
    case SafetyEvent::kOpened:
      return is_open ? state : SafetyState::kOpen;
    case SafetyEvent::kClosing:
      return SafetyState::kClosed;
    case SafetyEvent::kFailed:
      return is_open ? SafetyState::kFault : state;
    case SafetyEvent::kReply:
      if (!is_open || is_fault) return state;
      return has_origin ? SafetyState::kFault : SafetyState::kUncalibrated;
    case SafetyEvent::kHomed:
      if (!is_open || is_fault || has_origin) return state;
      return SafetyState::kIdle;
    case SafetyEvent::kAsked:
      return state == SafetyState::kIdle ? SafetyState::kRamping : state;
    case SafetyEvent::kRamped:
      return state == SafetyState::kRamping ? SafetyState::kActive : state;
    case SafetyEvent::kBroken:
      break;
  }
  if (permitsForce(state)) return SafetyState::kIdle;
  return state == SafetyState::kUncalibrated ? SafetyState::kOpen : state;
}

TEST(SafetyState, TheTableSaysWhatTheStatesMean) {
  for (std::size_t s = 0; s < kSafetyStates; ++s) {
    for (std::size_t e = 0; e < kSafetyEvents; ++e) {
      const auto state = static_cast<SafetyState>(s);
      const auto event = static_cast<SafetyEvent>(e);
      EXPECT_EQ(after(state, event), meant(state, event)) << nameOf(state) << ", " << nameOf(event);
    }
  }
}

TEST(SafetyState, NoTwoRulesContradictOneAnother) {
  for (std::size_t i = 0; i < kSafetyRules.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(kSafetyRules[i].from == kSafetyRules[k].from &&
                   kSafetyRules[i].event == kSafetyRules[k].event)
          << i << " and " << k;
    }
  }
}

TEST(SafetyState, OnlyClosingLeavesAFaultAndForceNeedsAnOriginAndARamp) {
  for (const SafetyRule& rule : kSafetyRules) {
    if (rule.from == SafetyState::kFault && rule.event != SafetyEvent::kFailed) {
      EXPECT_EQ(rule.event, SafetyEvent::kClosing);
    }
    if (rule.to == SafetyState::kActive) {
      EXPECT_EQ(rule.from, SafetyState::kRamping);
    }
    if (rule.to == SafetyState::kRamping) {
      EXPECT_EQ(rule.from, SafetyState::kIdle);
    }
  }
}

TEST(Safety, WithoutLimitsAForceIsNotTouched) {
  Safety safety = opened({});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-5.0, 5.0);
  for (int i = 2; i < 200; ++i) {
    const DeviceState here = at(Vec3(part(random)));
    ASSERT_EQ(safety.read(i * kTurn, DeviceStatus::kOk, here), ReadingVerdict::kSound);
    const Vec3 wanted(part(random), part(random), part(random));
    ASSERT_EQ(safety.ask(wanted, here).force, wanted);
    ASSERT_EQ(safety.state(), SafetyState::kActive);
  }
}

TEST(Safety, ZeroUntilHomedAndAFaultWhenTheOriginIsLost) {
  Safety safety(handLimits(), 10.0, kWatchdog, 0, kTurn);
  EXPECT_EQ(safety.state(), SafetyState::kClosed);
  safety.open(0);
  EXPECT_EQ(safety.state(), SafetyState::kOpen);
  const DeviceState lost = at(Vec3(0.0), false);
  (void)safety.read(kTurn, DeviceStatus::kOk, lost);
  EXPECT_EQ(safety.state(), SafetyState::kUncalibrated);
  EXPECT_FALSE(safety.ticks());
  EXPECT_EQ(safety.ask(Vec3(1.0), lost).force, Vec3(0.0));
  // Finding the origin moves the position farther than a hand can: that is not a jump.
  const DeviceState homed = at(Vec3(0.05));
  EXPECT_EQ(safety.read(2 * kTurn, DeviceStatus::kOk, homed), ReadingVerdict::kSound);
  EXPECT_EQ(safety.state(), SafetyState::kIdle);
  EXPECT_EQ(safety.ask(Vec3(1.0), homed).force, Vec3(0.0)) << "the ramp begins at zero";
  EXPECT_EQ(safety.state(), SafetyState::kRamping);
  (void)safety.read(3 * kTurn, DeviceStatus::kOk, at(Vec3(0.05), false));
  EXPECT_EQ(safety.state(), SafetyState::kFault);
  EXPECT_EQ(safety.fault(), SafetyFault::kHomingLost);
}

TEST(Safety, SilenceIsZeroAfterTenMillisecondsAndAFaultAfterAHundred) {
  Safety safety = opened(handLimits());
  const DeviceState here = at(Vec3(0.0));
  for (int i = 2; i <= 600; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kOk, here);
    (void)safety.ask(Vec3(1.0, 0.0, 0.0), here);
  }
  EXPECT_EQ(safety.state(), SafetyState::kActive);
  for (int i = 601; i < 610; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kStale, here);
    EXPECT_GT(safety.ask(Vec3(1.0, 0.0, 0.0), here).force.x, 0.0) << i;
  }
  for (int i = 610; i < 700; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kStale, here);
    EXPECT_EQ(safety.ask(Vec3(1.0, 0.0, 0.0), here).force, Vec3(0.0)) << i;
    EXPECT_EQ(safety.state(), SafetyState::kIdle);
  }
  (void)safety.read(700 * kTurn, DeviceStatus::kStale, here);
  EXPECT_EQ(safety.state(), SafetyState::kFault);
  EXPECT_EQ(safety.fault(), SafetyFault::kSilence);
}

TEST(Safety, ADeviceThatNeverRepliesIsAFault) {
  Safety safety(handLimits(), 10.0, kWatchdog, 0, kTurn);
  safety.open(0);
  (void)safety.read(99 * kTurn, DeviceStatus::kStale, {});
  EXPECT_EQ(safety.state(), SafetyState::kOpen);
  (void)safety.read(100 * kTurn, DeviceStatus::kStale, {});
  EXPECT_EQ(safety.fault(), SafetyFault::kSilence);
}

TEST(Safety, AClockThatGoesBackCountsAsNoTimeAndOneThatJumpsAheadInSilenceIsAFault) {
  Safety safety = opened(handLimits());
  const DeviceState here = at(Vec3(0.0));
  const Vec3 push(1.0, 0.0, 0.0);
  for (int i = 2; i <= 600; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kOk, here);
    (void)safety.ask(push, here);
  }
  for (const int i : {100, 101, 601}) {
    EXPECT_EQ(safety.read(i * kTurn, DeviceStatus::kOk, here), ReadingVerdict::kSound);
    EXPECT_EQ(safety.ask(push, here).force, push) << i;
    EXPECT_EQ(safety.state(), SafetyState::kActive);
  }
  (void)safety.read(1'000'000 * kTurn, DeviceStatus::kStale, here);
  EXPECT_EQ(safety.fault(), SafetyFault::kSilence);
  EXPECT_EQ(safety.ask(push, here).force, Vec3(0.0));
}

TEST(Safety, OneJumpIsDroppedAndThreeAreAFault) {
  Safety safety = opened(handLimits());
  const DeviceState here = at(Vec3(0.0));
  const DeviceState away = at(Vec3(0.5, 0.0, 0.0));
  EXPECT_EQ(safety.read(2 * kTurn, DeviceStatus::kOk, away), ReadingVerdict::kDropped);
  EXPECT_EQ(safety.read(3 * kTurn, DeviceStatus::kOk, here), ReadingVerdict::kSound);
  EXPECT_EQ(safety.read(4 * kTurn, DeviceStatus::kOk, away), ReadingVerdict::kDropped);
  EXPECT_EQ(safety.read(5 * kTurn, DeviceStatus::kOk, away), ReadingVerdict::kDropped);
  EXPECT_NE(safety.state(), SafetyState::kFault);
  (void)safety.read(6 * kTurn, DeviceStatus::kOk, away);
  EXPECT_EQ(safety.fault(), SafetyFault::kJump);
  EXPECT_EQ(safety.counts().jumps, 4U);
}

TEST(Safety, AHandThatIsTooFastIsAFaultAndOneThatIsNotIsNone) {
  for (const double speed : {1.8, 2.2}) {
    Safety safety = opened(handLimits());  // 2 m/s
    // The filter's speed after n steps of 1 ms is v (1 - 0.9^n): within 1 % after 44 of them.
    for (int i = 2; i < 100; ++i) {
      const Vec3 place(speed * 1e-3 * static_cast<double>(i - 1), 0.0, 0.0);
      (void)safety.read(i * kTurn, DeviceStatus::kOk, at(place));
    }
    EXPECT_EQ(safety.fault(), speed > 2.0 ? SafetyFault::kSpeed : SafetyFault::kNone) << speed;
  }
}

TEST(Safety, AValueThatIsNotFiniteIsZeroAndBeginsTheRampAnewAndThreeAreAFault) {
  Safety safety = opened(handLimits());
  const DeviceState here = at(Vec3(0.0));
  int i = 2;
  const auto ask = [&](const Vec3& wanted) {
    (void)safety.read(i++ * kTurn, DeviceStatus::kOk, here);
    return safety.ask(wanted, here).force;
  };
  const Vec3 push(1.0, 0.0, 0.0);
  while (i < 700) (void)ask(push);
  EXPECT_EQ(ask(push), push);
  EXPECT_EQ(ask(Vec3(kNan)), Vec3(0.0));
  EXPECT_EQ(safety.state(), SafetyState::kIdle);
  EXPECT_EQ(ask(push), Vec3(0.0));
  EXPECT_NEAR(ask(push).x, 1e-3 / 0.5, 1e-12) << "half a second to full force";
  for (int n = 0; n < 3; ++n) EXPECT_EQ(ask(Vec3(kNan)), Vec3(0.0));
  EXPECT_EQ(safety.fault(), SafetyFault::kNotFinite);
}

TEST(Safety, ALoopThatStoodStillRampsAndOneThatStoodForLongIsAFault) {
  Safety safety = opened(handLimits());
  safety.hang(30 * kTurn);
  EXPECT_EQ(safety.counts().hangs, 1U);
  EXPECT_EQ(safety.fault(), SafetyFault::kNone);
  safety.hang(100 * kTurn);
  EXPECT_EQ(safety.fault(), SafetyFault::kHung);
  safety.close();
  EXPECT_EQ(safety.state(), SafetyState::kClosed);
}

TEST(Safety, TheMotorsHeatIsThatOfTheContinuousForceAtMost) {
  SafetyLimits limits;
  limits.continuous_force = 2.0;
  limits.thermal_time = 1.0;
  Safety safety = opened(limits);
  const DeviceState here = at(Vec3(0.0));
  const Vec3 push(8.0, 0.0, 0.0);
  int full = 0;
  for (int i = 2; i < 20'000; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kOk, here);
    const double felt = safety.ask(push, here).force.x;
    ASSERT_GE(felt, 2.0);
    ASSERT_LE(safety.heat(), 1.0 + 1e-9);
    full += felt == 8.0 ? 1 : 0;
  }
  // At a load of 16 the heat is 16 (1 - exp(-t)). A force of 8 N is reduced when the permitted
  // force falls below it: at the heat h with 2 + 8 (1 - h) / 0.2 = 8, that is h = 0.85, after -ln(1
  // - 0.85 / 16) = 54.6 ms.
  EXPECT_NEAR(full, 55, 1);
  (void)safety.read(20'000 * kTurn, DeviceStatus::kOk, here);
  EXPECT_NEAR(safety.ask(push, here).force.x, 2.0, 1e-3);
}

/// Distance from `now` to the nearest multiple (0 to 1) of the last force.
double growth(const Vec3& last, const Vec3& now) {
  const double square = glm::dot(last, last);
  const double share = square > 0.0 ? std::clamp(glm::dot(now, last) / square, 0.0, 1.0) : 0.0;
  return glm::length(now - share * last);
}

/// The guarantees for a hand, derived again from everything that has happened so far, with the
/// test's clock.
struct Promise {
  SafetyLimits limits;
  std::int64_t longest;  // [ns] silence
  double max_force;
  std::int64_t sound = -1;  // time of the last sound reading
  std::int64_t reply = 0;
  std::int64_t broken = 0;  // time at which the ramp last had to begin anew
  Vec3 last{0.0};
  double heat = 0.0;       // [-] of the motors, 1 at most
  std::int64_t asked = 0;  // time at which a force was last asked for
  bool is_homed = false;
};

TEST(Safety, KeepsItsPromisesWhateverHappens) {
  const unsigned seed = 20240611;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  int faults = 0;
  int forces = 0;
  for (int run = 0; run < 400; ++run) {
    Promise p{};
    p.limits = handLimits();
    p.limits.max_growth = uniform(10.0, 5000.0);
    p.limits.ramp = uniform(0.005, 0.05);
    p.limits.continuous_force = uniform(0.5, 4.0);
    p.limits.thermal_time = uniform(0.05, 1.0);
    p.max_force = uniform(4.0, 12.0);
    p.longest = std::llround(1e9 * p.limits.silence);
    const double mischief = std::pow(10.0, uniform(-4.0, -0.5));  // share of turns with a fault
    Safety safety(p.limits, p.max_force, kWatchdog, 0, kTurn);
    safety.open(0);
    std::int64_t now = 0;
    Vec3 hand(0.0);
    for (int turn = 0; turn < 2000; ++turn) {
      const std::int64_t step = std::llround(1e6 * uniform(0.3, 1.8));
      now += step;
      hand += Vec3(uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)) * 1e-4;
      DeviceState reading = at(hand, turn > 20);
      auto status = DeviceStatus::kOk;
      bool is_broken = false;
      if (uniform(0.0, 1.0) < mischief) {
        switch (std::uniform_int_distribution<int>(0, 6)(random)) {
          case 0:
            status = DeviceStatus::kStale;
            break;
          case 1:
            now += std::llround(1e6 * uniform(0.0, 60.0));
            status = DeviceStatus::kStale;
            break;
          case 2:
            reading.position.y = kNan;
            break;
          case 3:
            reading.position.x += 1.0;
            break;
          case 4:
            safety.hang(std::llround(1e6 * uniform(20.0, 110.0)));
            is_broken = true;
            break;
          case 5:
            reading.is_homed = false;
            break;
          default:
            status = DeviceStatus::kFault;
            break;
        }
      }
      const bool was_over = safety.state() == SafetyState::kFault;
      const ReadingVerdict verdict = safety.read(now, status, reading);
      if (was_over) {
        ASSERT_EQ(safety.state(), SafetyState::kFault) << "latched";
      }
      if (status == DeviceStatus::kOk) p.reply = now;
      if (verdict == ReadingVerdict::kSound) {
        p.is_homed = reading.is_homed;
        p.sound = now;
      }
      const bool is_wild = uniform(0.0, 1.0) < mischief;
      Vec3 wanted(uniform(-20.0, 20.0), uniform(-20.0, 20.0), uniform(-20.0, 20.0));
      if (is_wild) wanted.z = turn % 2 == 0 ? kNan : kInfinity;
      const SafeForce safe = safety.ask(wanted, reading);
      const Vec3 force = safe.force;
      const double length = glm::length(force);
      ASSERT_TRUE(isFinite(force));
      ASSERT_LE(length, p.max_force * (1.0 + 1e-12));
      const bool may = !was_over && p.is_homed && p.sound >= 0 && now - p.sound < p.longest &&
                       now - p.reply < std::llround(1e9 * p.limits.silence_fault) &&
                       status != DeviceStatus::kFault && isFinite(wanted) &&
                       isFinite(reading.position);
      if (!may) {
        ASSERT_EQ(force, Vec3(0.0)) << nameOf(safety.state());
      }
      ASSERT_EQ(length > 0.0 && !permitsForce(safety.state()), false);
      // The force grows no faster than permitted: of a tick at most 1 ms counts.
      ASSERT_LE(growth(p.last, force), p.limits.max_growth * 1e-3 + 1e-9);
      // The motors' heat follows from the forces that were held, and hot motors get only the
      // continuous force.
      const double forever = p.limits.continuous_force;
      const double load = glm::dot(p.last, p.last) / (forever * forever);
      p.heat +=
          (load - p.heat) *
          (1.0 - std::exp(-1e-9 * static_cast<double>(now - p.asked) / p.limits.thermal_time));
      ASSERT_NEAR(safety.heat(), p.heat, 1e-9 * (1.0 + p.heat));
      const double cold = std::clamp((1.0 - p.heat) / 0.2, 0.0, 1.0);
      ASSERT_LE(length, std::max(p.max_force * cold + forever * (1.0 - cold), forever) + 1e-9);
      p.asked = now;
      if (is_broken || !may) p.broken = now;
      // The ramp: at most its share of the maximum since it last had to begin anew. Its duration is
      // in whole nanoseconds.
      const double since = 1e-9 * static_cast<double>(now - p.broken + 1);
      ASSERT_LE(length, p.max_force * std::min(1.0, since / p.limits.ramp) + 1e-9);
      p.last = force;
      forces += length > 0.0 ? 1 : 0;
    }
    faults += safety.state() == SafetyState::kFault ? 1 : 0;
    safety.close();
    EXPECT_EQ(safety.state(), SafetyState::kClosed);
  }
  EXPECT_GT(faults, 40);
  EXPECT_GT(forces, 100'000);
}

TEST(Safety, NeverAllocates) {
  Safety safety = opened(handLimits());
  const DeviceState here = at(Vec3(0.0));
  const testing::AllocGuard guard;
  for (int i = 2; i < 1000; ++i) {
    (void)safety.read(i * kTurn, DeviceStatus::kOk, here);
    (void)safety.ask(Vec3(3.0, 0.0, 0.0), here);
  }
  EXPECT_EQ(guard.violations(), 0);
}

}  // namespace
}  // namespace palpate::devices
