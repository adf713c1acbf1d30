#include "palpate/devices/velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "palpate/core/error.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

constexpr double kTick = 1e-3;  // [s]

VelocityTracker trackerOf(VelocityEstimator estimator, double window = 0.01, double noise = 0.0) {
  return VelocityTracker({estimator, window, noise});
}

constexpr VelocityEstimator kAll[] = {VelocityEstimator::kBackwardDifference,
                                      VelocityEstimator::kLeastSquares,
                                      VelocityEstimator::kAdaptiveWindow};

TEST(VelocityTracker, EvenMotionIsExactForAll) {
  const Vec3 v(0.3, -0.07, 0.0);
  for (const VelocityEstimator estimator : kAll) {
    VelocityTracker tracker = trackerOf(estimator, 0.01, 1e-12);
    EXPECT_EQ(tracker.add(0.0, Vec3(1.0)).value, Vec3(0.0));
    for (int n = 1; n < 200; ++n) {
      const double t = n * kTick;
      // Rounding of positions of a meter, divided by one interval.
      EXPECT_LT(glm::length(tracker.add(t, Vec3(1.0) + t * v).value - v), 1e-12);
    }
  }
}

TEST(VelocityTracker, ItIsTheVelocityAsLongAgoAsItSays) {
  // x = a t^2 / 2: the slope of a chord, and that of the least-squares line through equally spaced
  // times, is a times the time of their middle.
  constexpr double kA = 2.0;  // [m/s^2]
  for (const VelocityEstimator estimator : kAll) {
    VelocityTracker tracker = trackerOf(estimator, 0.02, 1e-5);
    for (int n = 0; n < 300; ++n) {
      const double t = n * kTick;
      const Velocity now = tracker.add(t, Vec3(0.5 * kA * t * t, 0.0, 0.0));
      if (n == 0) continue;
      EXPECT_NEAR(now.value.x, kA * (t - now.delay.x), 1e-10);
    }
  }
  VelocityTracker back = trackerOf(VelocityEstimator::kBackwardDifference);
  VelocityTracker line = trackerOf(VelocityEstimator::kLeastSquares, 0.02);
  Velocity one;
  Velocity other;
  for (int n = 0; n < 100; ++n) {
    one = back.add(n * kTick, Vec3(0.0));
    other = line.add(n * kTick, Vec3(0.0));
  }
  EXPECT_NEAR(one.delay.x, 0.5 * kTick, 1e-12);
  EXPECT_NEAR(other.delay.x, 0.01, 1e-12);
}

TEST(VelocityTracker, TheAdaptiveWindowIsLongOnASlowHandAndShortWhereItTurns) {
  constexpr double kStep = 1e-5;  // [m] of the encoder
  const auto read = [](double x) { return kStep * std::round(x / kStep); };
  VelocityTracker adaptive = trackerOf(VelocityEstimator::kAdaptiveWindow, 0.06, 1.001 * kStep);
  VelocityTracker back = trackerOf(VelocityEstimator::kBackwardDifference);
  double worst_adaptive = 0.0;
  double worst_back = 0.0;
  for (int n = 0; n < 400; ++n) {
    const double t = n * kTick;
    const Vec3 p(read(2e-3 * t), 0.0, 0.0);
    const double of_adaptive = adaptive.add(t, p).value.x;
    const double of_back = back.add(t, p).value.x;
    if (n < 60) continue;
    worst_adaptive = std::max(worst_adaptive, std::fabs(of_adaptive - 2e-3));
    worst_back = std::max(worst_back, std::fabs(of_back - 2e-3));
  }
  // One encoder step over a tick, and one encoder step over the whole window.
  EXPECT_NEAR(worst_back, kStep / kTick - 2e-3, 1e-9);
  EXPECT_LT(worst_adaptive, 1.001 * kStep / 0.06);
  // The hand changes its speed suddenly: within ten readings the window begins after the change.
  const double turn = 0.4;
  Velocity now;
  for (int n = 400; n < 411; ++n) {
    const double t = n * kTick;
    now = adaptive.add(t, Vec3(read(2e-3 * turn - 0.1 * (t - turn)), 0.0, 0.0));
  }
  EXPECT_LT(now.delay.x, 0.006);
  EXPECT_NEAR(now.value.x, -0.1, kStep / 5e-3);
}

TEST(VelocityTracker, GapsRepeatedTimesAndBrokenReadings) {
  for (const VelocityEstimator estimator : kAll) {
    VelocityTracker tracker = trackerOf(estimator, 0.005, 1e-9);
    for (int n = 0; n < 20; ++n) (void)tracker.add(n * kTick, Vec3(0.1 * n * kTick, 0.0, 0.0));
    const Velocity before = tracker.add(0.020, Vec3(0.1 * 0.020, 0.0, 0.0));
    // The same time again brings nothing new, whatever the position.
    EXPECT_EQ(tracker.add(0.020, Vec3(5.0)).value, before.value);
    EXPECT_EQ(tracker.add(0.010, Vec3(5.0)).value, before.value);
    // After a gap longer than the window only the last interval is left.
    const Velocity after = tracker.add(1.020, Vec3(0.1 * 0.020 + 0.5, 0.0, 0.0));
    EXPECT_NEAR(after.value.x, 0.5, 1e-12);
    EXPECT_NEAR(after.delay.x, 0.5, 1e-12);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(isFinite(tracker.add(1.021, Vec3(0.0, nan, 0.0)).value));
    EXPECT_EQ(tracker.add(1.022, Vec3(3.0)).value, Vec3(0.0));
    EXPECT_NEAR(tracker.add(1.023, Vec3(3.001, 3.0, 3.0)).value.x, 1.0, 1e-9);
  }
}

TEST(VelocityTracker, AWrongTimeStampIsForgottenWhateverItIs) {
  // A hand moves at 0.1 m/s until one time stamp is wrong, or the clock is changed for good, and
  // then rests. 10 ms later the window contains only rest.
  const double inf = std::numeric_limits<double>::infinity();
  for (const VelocityEstimator estimator : kAll) {
    for (const double wrong : {-inf, -1e300, -5.0, 0.1, 0.3, 3.0, 1000.0, 1e300, inf}) {
      for (const bool is_for_good : {false, true}) {
        if (is_for_good && std::fabs(wrong) > 1e6) continue;
        VelocityTracker tracker = trackerOf(estimator, 0.01, 1e-9);
        for (int n = 0; n < 200; ++n) (void)tracker.add(n * kTick, Vec3(1e-4 * n, 0.0, 0.0));
        Velocity now;
        for (int n = 200; n < 220; ++n) {
          const double set = is_for_good ? wrong + (n - 200) * kTick : n == 200 ? wrong : n * kTick;
          now = tracker.add(set, Vec3(0.02, 0.0, 0.0));
        }
        EXPECT_EQ(now.value, Vec3(0.0)) << wrong << (is_for_good ? " for good" : " once");
      }
    }
    // After a gap during which the hand's motion is unknown, a reading counts as a first one.
    VelocityTracker tracker = trackerOf(estimator, 100.0);
    (void)tracker.add(0.0, Vec3(0.0));
    EXPECT_GT(tracker.add(VelocityTracker::kLongestGap, Vec3(1.0)).value.x, 0.0);
    EXPECT_EQ(tracker.add(2.001 * VelocityTracker::kLongestGap, Vec3(2.0)).value, Vec3(0.0));
  }
}

TEST(VelocityTracker, LeastSquaresIsTheLineThatNormalEquationsGive) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  VelocityTracker tracker = trackerOf(VelocityEstimator::kLeastSquares, 0.0101);
  std::vector<std::pair<double, double>> all;
  double t = 5.0;
  for (int n = 0; n < 500; ++n) {
    t += kTick * (0.5 + any(random));
    const double x = any(random);
    all.emplace_back(t, x);
    const double slope = tracker.add(t, Vec3(0.0, x, 0.0)).value.y;
    // Sums over the readings of the last 10.1 ms, at least two.
    double count = 0.0;
    double st = 0.0;
    double sx = 0.0;
    double stt = 0.0;
    double stx = 0.0;
    for (std::size_t k = all.size(); k-- > 0;) {
      const double back = all[k].first - t;
      if (-back > 0.0101 && count >= 2.0) break;
      count += 1.0;
      st += back;
      sx += all[k].second;
      stt += back * back;
      stx += back * all[k].second;
    }
    if (n == 0) continue;
    const double wanted = (count * stx - st * sx) / (count * stt - st * st);
    EXPECT_NEAR(slope, wanted, 1e-9 * std::max(1.0, std::fabs(wanted)));
  }
}

TEST(VelocityTracker, NeverAllocatesAndRefusesWhatCannotBe) {
  for (const VelocityEstimator estimator : kAll) {
    VelocityTracker tracker = trackerOf(estimator, 1.0, 1e-3);
    const testing::AllocGuard guard;
    for (int n = 0; n < 300; ++n) (void)tracker.add(n * kTick, Vec3(1e-4 * (n % 7)));
    EXPECT_EQ(guard.violations(), 0);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double window : {0.0, -1.0, nan}) {
    EXPECT_THROW(trackerOf(VelocityEstimator::kLeastSquares, window), Error);
  }
  EXPECT_THROW(trackerOf(static_cast<VelocityEstimator>(7)), Error);
  for (const double noise : {-1e-9, nan}) {
    EXPECT_THROW(trackerOf(VelocityEstimator::kAdaptiveWindow, 0.01, noise), Error);
  }
}

}  // namespace
}  // namespace palpate::devices
