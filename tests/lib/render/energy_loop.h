#pragma once
// The work that a rendered world does on a hand that moves along a closed path.

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "lib/render/drive.h"
#include "palpate/render/tick_state.h"
#include "support/random_hand.h"

namespace palpate::test {

/// A smooth closed path around a point.
struct EnergyLoop {
  Vec3 center{0.0, 0.0, 0.0};  // [m]
  std::array<Vec3, 4> wave{};  // [m]

  [[nodiscard]] Vec3 at(double share) const {
    const double turn = 2.0 * std::numbers::pi * share;
    return center + std::cos(turn) * wave[0] + std::sin(turn) * wave[1] +
           std::cos(2.0 * turn) * wave[2] + std::sin(2.0 * turn) * wave[3];
  }
};

/// A hand on its way around a loop, and the work done on it.
class LoopHand {
 public:
  /// Moves from `start` [m] to where the loop begins. A lap takes `lap` [s].
  LoopHand(const ScenePtr& scene, const Vec3& start, EnergyLoop loop, int steps, double lap = 1.0)
      : renderer_(makeRenderer(scene)),
        loop_(std::move(loop)),
        steps_(steps),
        dt_(lap / steps),
        last_(start) {
    force_ = renderer_->update({start, Vec3(0.0), dt_}).force;
    constexpr int kWayIn = 500;
    for (int i = 1; i <= kWayIn; ++i) {
      goTo(glm::mix(start, loop_.at(0.0), 1.0 * i / kWayIn), dt_, 0);
    }
  }

  /// One lap; steps in which the force changes by more than kStepped are halved up to `halvings`
  /// times, so that it does not matter where within a step the force jumps.
  void lap(int halvings = 0) {
    for (int i = 1; i <= steps_; ++i) {
      goTo(loop_.at(i == steps_ ? 0.0 : static_cast<double>(i) / steps_), dt_, halvings);
    }
  }

  /// [J] Work done on the hand since it was at `start`, by the trapezoidal rule, beyond counted
  /// sources ...
  [[nodiscard]] double work() const { return work_ - renderer_->sourceWork(); }
  /// [J] ... and the energy that tissue around a needle holds, which the hand gave to it: the
  /// tissue returns it over many laps.
  [[nodiscard]] double inTissue() const {
    return TickState::of(renderer_->state()).needle.stored();
  }

 private:
  static constexpr double kStepped = 0.01;  // [N]

  void goTo(const Vec3& to, double dt, int halvings) {
    const Vec3 from = last_;
    std::optional<RendererState> before;
    if (halvings > 0) before = renderer_->state();
    const Vec3 now = renderer_->update({to, (to - from) / dt, dt}).force;
    if (before && glm::length(now - force_) > kStepped && renderer_->setState(*before)) {
      goTo(0.5 * (from + to), 0.5 * dt, halvings - 1);
      goTo(to, 0.5 * dt, halvings - 1);
      return;
    }
    work_ += 0.5 * glm::dot(force_ + now, to - from);
    force_ = now;
    last_ = to;
  }

  std::unique_ptr<HapticRenderer> renderer_;
  EnergyLoop loop_;
  int steps_;
  double dt_;          // [s]
  Vec3 last_;          // [m]
  Vec3 force_{0.0};    // [N]
  double work_ = 0.0;  // [J]
};

/// The number of halvings of a step in which the force jumps.
inline constexpr int kHalvings = 20;

/// [J] Work on the hand in the lap after `before` others, beyond counted sources. A lap takes `lap`
/// [s].
inline double workOfLap(const ScenePtr& scene, const Vec3& start, const EnergyLoop& loop, int steps,
                        double lap = 1.0, int before = 1) {
  LoopHand hand(scene, start, loop, steps, lap);
  for (int k = 0; k < before; ++k) hand.lap();
  const double work = hand.work();
  hand.lap(kHalvings);
  return hand.work() - work;
}

/// [N] Minus the gradient of the energy [J] at `hand` [m], by central differences over `step` [m].
template <typename Energy>
Vec3 fallOf(const Energy& energy, const Vec3& hand, double step) {
  Vec3 out(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 by(0.0);
    by[axis] = step;
    out[axis] = (energy(hand - by) - energy(hand + by)) / (2.0 * step);
  }
  return out;
}

struct EnergyGiven {
  double work = 0.0;    // [J] in the limit of short steps
  double change = 0.0;  // [J] change by the last halving of the step
  double moved = 0.0;   // [J] half the absolute work of the lap: the energy that went to and fro
};

/// The same, with the step halved until the result changes by less than 1e-10 J, or there are
/// `most` steps. Two laps with coarse steps may agree by chance, so a positive result is refined up
/// to `most`.
inline EnergyGiven energyGiven(const ScenePtr& scene, const Vec3& start, const EnergyLoop& loop,
                               int most = 64'000, double lap = 1.0) {
  EnergyGiven out;
  int steps = 1000;
  out.work = workOfLap(scene, start, loop, steps, lap);
  do {
    steps *= 2;
    const double finer = workOfLap(scene, start, loop, steps, lap);
    out.change = std::fabs(finer - out.work);
    out.work = finer;
  } while ((out.change > 1e-10 || out.work > 1e-9) && steps < most);
  return out;
}

/// The same for the eighth lap, in short steps, and the shortest where the force jumps. By then
/// friction holds the proxy at the same places in every lap, so that the energy stored at a lap's
/// end is that stored at its beginning. Tissue around a needle is cut or slips a little in every
/// lap and returns less and less of the energy that the hand put in on its way in: the decrease
/// during the lap is the hand's own energy.
inline EnergyGiven energyGivenAtLast(const ScenePtr& scene, const Vec3& start,
                                     const EnergyLoop& loop) {
  const auto work = [&](int steps) {
    LoopHand hand(scene, start, loop, steps);
    for (int k = 0; k < 7; ++k) hand.lap();
    const double before = hand.work() + hand.inTissue();
    hand.lap(kHalvings);
    return hand.work() + hand.inTissue() - before;
  };
  EnergyGiven out;
  out.work = work(32'000);
  out.change = std::fabs(out.work - work(16'000));
  return out;
}

/// A loop around `center` whose waves are `least` to `most` [m] long.
inline EnergyLoop randomLoop(Random& random, const Vec3& center, double least, double most) {
  EnergyLoop out;
  out.center = center;
  for (Vec3& each : out.wave) each = random.uniform(least, most) * random.direction();
  return out;
}

/// Twelve small loops around `center` [m] in a world with friction: none may give more than 1 nJ.
inline void expectFrictionTakes(const char* name, const ScenePtr& scene, Random& random,
                                const Vec3& center) {
  double most = -kInfinity;
  for (int i = 0; i < 12; ++i) {
    const EnergyLoop loop = randomLoop(random, center, 0.02e-3, 0.8e-3);
    most = std::max(most, workOfLap(scene, mm(0, 0, 10), loop, 16'000));
  }
  std::printf("  friction %s: at most %.3g J\n", name, most);
  EXPECT_LE(most, 1e-9) << name;
}

/// Searches the loop that gives the most energy, by changing the best one so far slightly, `tries`
/// times.
inline EnergyLoop worstLoop(const ScenePtr& scene, const Vec3& start, EnergyLoop best, double size,
                            int tries, Random& random) {
  constexpr int kSteps = 2000;
  double most = workOfLap(scene, start, best, kSteps);
  for (int i = 0; i < tries; ++i) {
    EnergyLoop next = best;
    const double by = size * (i % 3 == 0 ? 0.5 : 0.1);
    next.center += by * random.direction();
    for (Vec3& each : next.wave) each += by * random.direction();
    const double work = workOfLap(scene, start, next, kSteps);
    if (work <= most) continue;
    most = work;
    best = next;
  }
  return best;
}

}  // namespace palpate::test
