// For any combination of mapping, clutch, estimator and readings, a session's results equal those
// of a few lines of arithmetic: the probe's way summed from the hand's, rotated by Rodrigues'
// formula; the velocity from its definition; the force of one plane wall.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "palpate/devices/session.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

class RandomSession {
 public:
  explicit RandomSession(unsigned seed) : random_(seed) {}

  /// [m] The deepest that the hand was in the floor.
  [[nodiscard]] double deepest() const { return deepest_; }
  /// Runs a case with all its readings; stops at the first failure.
  void run() {
    draw();
    Session session(scene_, settings_);
    for (int n = 0; n < 600; ++n) {
      DeviceState reading = next(n);
      const testing::AllocGuard guard;
      const SessionTick tick = session.step(reading, frame_);
      ASSERT_EQ(guard.violations(), 0);
      ASSERT_NO_FATAL_FAILURE(judge(reading, tick)) << "tick " << n;
    }
  }

 private:
  static constexpr double kStiffness = 700.0;  // [N/m]

  double any(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random_);
  }
  bool chance(double share) { return any(0.0, 1.0) < share; }

  /// `v` rotated about axis_ by `angle`: Rodrigues' formula.
  [[nodiscard]] Vec3 turned(const Vec3& v, double angle) const {
    return v * std::cos(angle) + glm::cross(axis_, v) * std::sin(angle) +
           axis_ * (glm::dot(axis_, v) * (1.0 - std::cos(angle)));
  }

  void draw() {
    axis_ = glm::normalize(Vec3(any(-1.0, 1.0), any(-1.0, 1.0), any(0.1, 1.0)));
    angle_ = chance(0.2) ? 0.0 : any(-3.0, 3.0);
    scale_ = std::exp(any(-2.0, 2.0));
    force_ = std::exp(any(-2.0, 2.0));
    offset_ = Vec3(any(-0.1, 0.1), any(-0.1, 0.1), any(-0.1, 0.1));
    has_clutch_ = chance(0.7);
    frame_ = chance(0.8) ? DeviceFrame::kDevice : DeviceFrame::kWorld;
    if (frame_ == DeviceFrame::kWorld) {
      angle_ = 0.0;
      scale_ = force_ = 1.0;
      offset_ = Vec3(0.0);
    }
    button_ = static_cast<int>(any(0.0, 31.99));
    settings_.clutch_button = button_;
    settings_.velocity.estimator = static_cast<VelocityEstimator>(static_cast<int>(any(0.0, 2.99)));
    settings_.velocity.window = any(1e-3, 0.02);
    settings_.velocity.noise = any(0.0, 1e-4);
    settings_.servo.rate = any(500.0, 4000.0);

    SceneDescription description = parseScene(R"(
palpate: 1
length: mm
materials: {wall: {stiffness: 700 N/m}}
layers:
  - {name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: wall}
)",
                                              "random.yaml");
    description.device.clutch = has_clutch_;
    if (frame_ == DeviceFrame::kDevice) {
      description.device.offset = offset_;
      description.device.rotation = rotationAbout(axis_, angle_);
      description.device.scale = scale_;
      description.device.force = force_;
    }
    scene_ = compile(description);
    // Above the floor, by some millimeters in the world.
    hand_ = turned(Vec3(0.0, 0.0, 0.004) - offset_, -angle_) / scale_;
  }

  /// The hand wanders towards places of which half are in the floor; buttons are pressed and
  /// released for a while.
  DeviceState next(int n) {
    if (n % 40 == 0) way_ = Vec3(any(-1.0, 1.0), any(-1.0, 1.0), any(-1.0, 1.0)) * 1e-4;
    if (has_probe_ && probe_.z > 0.006) way_ = turned(Vec3(0.0, 0.0, -1e-4), -angle_);
    if (has_probe_ && probe_.z < -0.006) way_ = turned(Vec3(0.0, 0.0, 1e-4), -angle_);
    hand_ += way_ / scale_;
    time_ += chance(0.05) ? any(0.01, 0.1) : any(0.2e-3, 2e-3);
    if (chance(0.04)) buttons_ ^= 1U << static_cast<unsigned>(button_);
    if (chance(0.1)) buttons_ ^= 1U << static_cast<unsigned>((button_ + 1 + n % 31) % 32);
    DeviceState out{.time = time_, .position = hand_, .buttons = buttons_};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (chance(0.02)) out.position[n % 3] = nan;
    if (chance(0.005)) out.time = nan;
    return out;
  }

  /// [m/s, device] By the estimator's definition, from all readings since the last broken one.
  [[nodiscard]] Vec3 velocityNow() const {
    const std::size_t last = history_.size() - 1;
    if (last == 0) return Vec3(0.0);
    if (settings_.velocity.estimator == VelocityEstimator::kBackwardDifference) {
      return (history_[last].second - history_[last - 1].second) /
             (history_[last].first - history_[last - 1].first);
    }
    std::size_t begin = last - 1;
    while (begin > 0 &&
           history_[last].first - history_[begin - 1].first <= settings_.velocity.window)
      --begin;
    Vec3 out(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      out[axis] = settings_.velocity.estimator == VelocityEstimator::kLeastSquares
                      ? slopeOfLine(begin, axis)
                      : slopeOfChord(begin, axis);
    }
    return out;
  }
  /// Solves the normal equations, with the mean of the readings as origin.
  [[nodiscard]] double slopeOfLine(std::size_t begin, int axis) const {
    double t = 0.0;
    double x = 0.0;
    const auto count = static_cast<double>(history_.size() - begin);
    for (std::size_t i = begin; i < history_.size(); ++i) {
      t += history_[i].first / count;
      x += history_[i].second[axis] / count;
    }
    double tt = 0.0;
    double tx = 0.0;
    for (std::size_t i = begin; i < history_.size(); ++i) {
      tt += (history_[i].first - t) * (history_[i].first - t);
      tx += (history_[i].first - t) * (history_[i].second[axis] - x);
    }
    return tx / tt;
  }
  /// Slope of the longest chord for which no reading is farther than the noise from it or from any
  /// shorter chord.
  [[nodiscard]] double slopeOfChord(std::size_t begin, int axis) const {
    const std::size_t last = history_.size() - 1;
    double slope = 0.0;
    for (std::size_t from = last; from-- > begin;) {
      const double run = history_[last].first - history_[from].first;
      const double now = (history_[last].second[axis] - history_[from].second[axis]) / run;
      bool keeps = true;
      for (std::size_t i = from + 1; i < last; ++i) {
        const double on =
            history_[from].second[axis] + now * (history_[i].first - history_[from].first);
        keeps = keeps && std::fabs(on - history_[i].second[axis]) <= settings_.velocity.noise;
      }
      if (!keeps) break;
      slope = now;
    }
    return slope;
  }

  void judge(const DeviceState& reading, const SessionTick& tick) {
    const double since = std::isfinite(reading.time)
                             ? (has_time_ ? reading.time - last_time_ : 1.0 / settings_.servo.rate)
                             : 0.0;
    if (std::isfinite(reading.time)) {
      last_time_ = reading.time;
      has_time_ = true;
    }
    ASSERT_DOUBLE_EQ(tick.dt, since);
    if (!std::isfinite(reading.time) || !isFinite(reading.position)) {
      history_.clear();
      ASSERT_EQ(tick.force, Vec3(0.0));
      return;
    }
    history_.emplace_back(reading.time, reading.position);
    const Vec3 velocity = scale_ * turned(velocityNow(), angle_);

    // The clutch's state after the previous reading decides how the way since then counts.
    const double level = std::min(1.0, since / Clutch::kFade);
    shown_ = std::clamp(shown_ + (was_held_ ? -level : level), 0.0, 1.0);
    since_turn_ = std::min(1.0, since_turn_ + level);
    if (!has_probe_) probe_ = offset_ + scale_ * turned(reading.position, angle_);
    if (has_probe_ && !was_held_) probe_ += scale_ * turned(reading.position - last_, angle_);
    last_ = reading.position;
    has_probe_ = true;
    const auto smooth = [](double s) { return 3.0 * s * s - 2.0 * s * s * s; };
    const Vec3 goal = was_held_ ? Vec3(0.0) : velocity;
    const double got = smooth(since_turn_);
    const Vec3 wanted_velocity = (1.0 - got) * turn_velocity_ + got * goal;
    const bool held = has_clutch_ && (reading.buttons >> static_cast<unsigned>(button_) & 1U) == 1U;
    if (held != was_held_) {
      turn_velocity_ = wanted_velocity;
      since_turn_ = 0.0;
    }
    was_held_ = held;

    // Rounding of sums of 600 ways of about 0.1 m.
    ASSERT_LT(glm::length(tick.hip.position - probe_), 1e-13);
    // The same divided by the shortest interval, 0.2 ms.
    ASSERT_LT(glm::length(tick.hip.velocity - wanted_velocity),
              1e-9 * (1.0 + glm::length(velocity)));
    const double depth = std::max(0.0, -probe_.z);
    deepest_ = std::max(deepest_, depth * smooth(shown_));
    const Vec3 wanted =
        force_ * smooth(shown_) * kStiffness * turned(Vec3(0.0, 0.0, depth), -angle_);
    ASSERT_LT(glm::length(tick.force - wanted), 1e-9 * (1.0 + force_));
  }

  std::mt19937 random_;
  Vec3 axis_{0.0, 0.0, 1.0};
  double angle_ = 0.0;
  double scale_ = 1.0;
  double force_ = 1.0;
  Vec3 offset_{0.0};
  bool has_clutch_ = false;
  int button_ = 0;
  DeviceFrame frame_ = DeviceFrame::kDevice;
  SessionSettings settings_;
  ScenePtr scene_;

  // The hand.
  Vec3 hand_{0.0};
  Vec3 way_{0.0};
  double time_ = 3.0;
  unsigned buttons_ = 0;

  // What the model remembers of earlier ticks.
  std::vector<std::pair<double, Vec3>> history_;
  bool has_time_ = false;
  double last_time_ = 0.0;
  bool has_probe_ = false;
  Vec3 probe_{0.0};
  Vec3 last_{0.0};
  bool was_held_ = false;
  double shown_ = 1.0;
  double since_turn_ = 1.0;
  Vec3 turn_velocity_{0.0};
  double deepest_ = 0.0;
};

TEST(SessionRandom, MappingClutchAndVelocityAreWhatArithmeticSays) {
  const unsigned cases = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 3000 : 60;
  unsigned felt = 0;
  for (unsigned seed = 0; seed < cases; ++seed) {
    RandomSession session(seed);
    session.run();
    ASSERT_FALSE(::testing::Test::HasFailure()) << "seed " << seed;
    if (session.deepest() > 1e-3) ++felt;
  }
  EXPECT_GT(felt, cases / 3) << "too few hands came to the floor";
}

}  // namespace
}  // namespace palpate::devices
