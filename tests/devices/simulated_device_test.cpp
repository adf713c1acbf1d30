// A device with dynamics against closed forms, a fine Runge-Kutta integration and the energy
// balance.

#include "palpate/devices/simulated_device.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <random>

#include "palpate/core/error.h"
#include "palpate/devices/device.h"
#include "palpate/devices/device_presets.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

/// A hand that rests at one place.
Path still(double seconds, const Vec3& at = Vec3(0.0)) { return {{0.0, at}, {seconds, at}}; }

SimulationSettings bare(double mass, double damping, double friction = 0.0) {
  SimulationSettings settings;
  settings.device.mass = mass;
  settings.device.damping = damping;
  settings.device.friction = friction;
  return settings;
}

/// Reads, then writes the force that `force` returns, for `ticks` ticks.
template <typename Force>
void run(SimulatedDevice& device, int ticks, const Force& force) {
  DeviceState reading;
  for (int k = 0; k < ticks; ++k) {
    ASSERT_EQ(device.read(reading), DeviceStatus::kOk) << k;
    ASSERT_EQ(device.write(force(k)), DeviceStatus::kOk) << k;
  }
  ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
}

TEST(SimulatedDevice, WithoutFrictionAHeldForceMovesItByTheClosedForm) {
  SimulatedDevice device(bare(0.2, 0.5), still(1.0));
  device.open();
  run(device, 100, [](int) { return Vec3(1.0, -2.0, 0.0); });
  const double t = 0.1;
  const double rate = 0.5 / 0.2;
  const double gone = -std::expm1(-rate * t);
  const double v = gone / 0.5;
  const double x = (t - gone / rate) / 0.5;
  EXPECT_NEAR(device.velocity().x, v, 1e-13);
  EXPECT_NEAR(device.position().x, x, 1e-14);
  EXPECT_NEAR(device.velocity().y, -2.0 * v, 1e-13);
  EXPECT_NEAR(device.position().y, -2.0 * x, 1e-14);
  EXPECT_EQ(device.position().z, 0.0);
}

TEST(SimulatedDevice, AHandThatIsAskedMeanwhileGoesAsOneWhosePathIsKnown) {
  SimulationSettings settings{.device = devicePreset("touch").model(),
                              .hand = handPreset("relaxed")};
  const auto place = [](double t) {
    return Vec3(0.02 * std::sin(7.0 * t), 0.01 * t, -0.03 * t * t);
  };
  SimulatedDevice known(settings, PathFormula(500, 1000.0, place(0.5), place));
  double last = -1.0;
  const auto asked = [&](double t) {
    EXPECT_GE(t, last);
    last = t;
    return place(t);
  };
  SimulatedDevice live(settings, LiveHand{.position = asked, .end = 0.5});
  known.open();
  live.open();
  DeviceState a;
  DeviceState b;
  for (int k = 0; k <= 500; ++k) {
    ASSERT_EQ(known.read(a), DeviceStatus::kOk) << k;
    ASSERT_EQ(live.read(b), DeviceStatus::kOk) << k;
    ASSERT_EQ(a.position, b.position) << k;
    ASSERT_EQ(a.time, b.time) << k;
    const Vec3 force = -200.0 * a.position;
    ASSERT_EQ(known.write(force), DeviceStatus::kOk) << k;
    ASSERT_EQ(live.write(force), DeviceStatus::kOk) << k;
  }
  EXPECT_EQ(known.read(a), DeviceStatus::kEnd);
  EXPECT_EQ(live.read(b), DeviceStatus::kEnd);
}

TEST(SimulatedDevice, FrictionStopsItWhenAndWhereTheClosedFormSays) {
  // Pushed for 20 ms with 1 N against 0.3 N of friction, then released: it stops within a tick and
  // stays at rest.
  const double m = 0.2;
  const double b = 0.5;
  const double f = 0.3;
  const double rate = b / m;
  SimulatedDevice device(bare(m, b, f), still(1.0));
  device.open();
  DeviceState reading;
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
    ASSERT_EQ(device.write(Vec3(k < 20 ? 1.0 : 0.0, 0.0, 0.0)), DeviceStatus::kOk);
  }
  const double pushed = (1.0 - f) / b;
  const double gone = -std::expm1(-rate * 0.02);
  const double v0 = pushed * gone;
  const double x0 = pushed * (0.02 - gone / rate);
  const double drag = -f / b;
  const double stop = std::log1p(-v0 / drag) / rate;
  const double x = x0 + drag * stop + (v0 - drag) * -std::expm1(-rate * stop) / rate;
  EXPECT_EQ(device.velocity().x, 0.0);
  EXPECT_NEAR(device.position().x, x, 1e-13);
  const DeviceWork work = device.work();
  EXPECT_NEAR(work.friction, f * x, 1e-14);
  EXPECT_NEAR(work.motor, x0, 1e-14);
}

TEST(SimulatedDevice, SticksUpToTheFrictionAndSlidesBeyond) {
  for (const double force : {0.2999, 0.3, 0.3001}) {
    SimulatedDevice device(bare(0.2, 0.0, 0.3), still(1.0));
    device.open();
    run(device, 100, [&](int) { return Vec3(0.0, -force, 0.0); });
    const double expected = force > 0.3 ? -0.5 * (force - 0.3) / 0.2 * 0.01 : 0.0;
    EXPECT_NEAR(device.position().y, expected, 1e-14) << force;
  }
}

TEST(SimulatedDevice, ADelayedForceComesSoManySamplesLater) {
  for (const int delay : {0, 1, 3, SimulatedDevice::kMostDelay}) {
    SimulationSettings settings = bare(0.2, 0.0);
    settings.delay = delay;
    SimulatedDevice device(settings, still(1.0));
    device.open();
    run(device, 100, [](int k) { return Vec3(k == 0 ? 2.0 : 0.0, 0.0, 0.0); });
    // 10 m/s^2 for one tick, then coasting.
    const double expected = 0.5 * 10.0 * 1e-6 + 0.01 * (100 - 1 - delay) * 1e-3;
    EXPECT_NEAR(device.position().x, expected, 1e-15) << delay;
  }
}

TEST(SimulatedDevice, ALagFollowsItsCommandByTheClosedForm) {
  SimulationSettings settings = bare(0.2, 0.0);
  settings.device.lag = 2e-3;
  SimulatedDevice device(settings, still(1.0));
  device.open();
  run(device, 50, [](int) { return Vec3(0.0, 0.0, 1.0); });
  const double t = 0.05;
  const double tau = 2e-3;
  // F = 1 - e^(-t / tau), integrated twice.
  const double gone = -std::expm1(-t / tau);
  const double expected = (0.5 * t * t - tau * t + tau * tau * gone) / 0.2;
  EXPECT_NEAR(device.position().z, expected, 1e-14);
  // The work of a force that is not constant: all of it becomes motion.
  const double v = (t - tau * gone) / 0.2;
  EXPECT_NEAR(device.work().motor, 0.5 * 0.2 * v * v, 1e-14);
}

TEST(SimulatedDevice, TheMotorsSaturateWithTheirDirectionKept) {
  SimulationSettings settings = bare(0.2, 0.0);
  settings.device.max_force = 2.0;
  SimulatedDevice device(settings, still(1.0));
  device.open();
  DeviceState reading;
  ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
  ASSERT_EQ(device.write(Vec3(3.0, 4.0, 0.0)), DeviceStatus::kOk);
  EXPECT_NEAR(glm::length(device.heldForce() - Vec3(1.2, 1.6, 0.0)), 0.0, 1e-15);
  EXPECT_EQ(device.info().max_force, 2.0);
  ASSERT_EQ(device.write(Vec3(std::nan(""), 0.0, 0.0)), DeviceStatus::kOk);
  EXPECT_EQ(device.heldForce(), Vec3(0.0));
}

TEST(SimulatedDevice, ReadingsAreMultiplesOfTheEncodersStep) {
  SimulationSettings settings = bare(0.2, 0.5);
  settings.device.encoder = 40e-6;
  SimulatedDevice device(settings, still(1.0, Vec3(1e-3, 0.0, 0.0)));
  device.open();
  DeviceState reading;
  double last = 0.0;
  for (int k = 0; k < 200; ++k) {
    ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
    const double steps = reading.position.x / 40e-6;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::fabs(reading.position.x - device.position().x), 20e-6 * (1.0 + 1e-9));
    if (k > 0) {
      EXPECT_NEAR(reading.velocity.x, (reading.position.x - last) / 1e-3, 1e-9);
    }
    last = reading.position.x;
    ASSERT_EQ(device.write(Vec3(0.3, 0.0, 0.0)), DeviceStatus::kOk);
  }
}

/// One axis of the same device, by the Runge-Kutta method in very short steps.
class FineAxis {
 public:
  FineAxis(const SimulationSettings& settings, double x) : s_(settings), z_{x, 0.0, x, 0.0, 0.0} {}

  void go(double command, double path, double path_rate, double span, int steps) {
    const double h = span / steps;
    for (int n = 0; n < steps; ++n) {
      const double p = path + path_rate * h * n;
      if (s_.device.lag == 0.0) z_[4] = command;
      const State before = z_;
      decide(command, p, path_rate);
      step(command, p, path_rate, h);
      if (s_.device.friction == 0.0 || way_ == 0 || z_[1] * way_ > 0.0) continue;
      // It stops within the step: the place is found by the secant, and integration restarts from
      // there.
      const double there = h * before[1] / (before[1] - z_[1]);
      z_ = before;
      step(command, p, path_rate, there);
      z_[1] = 0.0;
      way_ = 0;
      decide(command, p + there * path_rate, path_rate);
      step(command, p + there * path_rate, path_rate, h - there);
    }
  }
  [[nodiscard]] double x() const { return z_[0]; }

 private:
  using State = std::array<double, 5>;  // x, v, hand x, hand v, motor
  static State plus(const State& z, const State& slope, double h) {
    State out = z;
    for (std::size_t i = 0; i < 5; ++i) out[i] += h * slope[i];
    return out;
  }
  /// Called at rest: decides whether the device sticks or slips.
  void decide(double command, double p, double rate) {
    const double net = force(z_, command, p, rate);
    if (way_ == 0 && std::fabs(net) > s_.device.friction) way_ = net > 0.0 ? 1 : -1;
  }
  void step(double command, double p, double rate, double h) {
    const State a = slope(z_, command, p, rate);
    const State b = slope(plus(z_, a, 0.5 * h), command, p + 0.5 * h * rate, rate);
    const State c = slope(plus(z_, b, 0.5 * h), command, p + 0.5 * h * rate, rate);
    const State d = slope(plus(z_, c, h), command, p + h * rate, rate);
    for (std::size_t i = 0; i < 5; ++i) z_[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  /// [N] on the device, without Coulomb friction.
  [[nodiscard]] double force(const State& z, double, double p, double rate) const {
    double sum = z[4] - s_.device.damping * z[1];
    if (!s_.hand) return sum;
    const HandModel& h = *s_.hand;
    if (h.hasGrip()) return sum + h.grip_stiffness * (z[2] - z[0]) + h.grip_damping * (z[3] - z[1]);
    return sum + h.stiffness * (p - z[0]) + h.damping * (rate - z[1]);
  }
  [[nodiscard]] State slope(const State& z, double command, double p, double rate) const {
    State d{};
    double mass = s_.device.mass;
    if (s_.hand && !s_.hand->hasGrip()) mass += s_.hand->mass;
    const bool moves = s_.device.friction == 0.0 || way_ != 0;
    d[0] = moves ? z[1] : 0.0;
    d[1] = moves ? (force(z, command, p, rate) - way_ * s_.device.friction) / mass : 0.0;
    if (s_.hand && s_.hand->hasGrip()) {
      const HandModel& h = *s_.hand;
      d[2] = z[3];
      d[3] = (h.grip_stiffness * (z[0] - z[2]) + h.grip_damping * (z[1] - z[3]) +
              h.stiffness * (p - z[2]) + h.damping * (rate - z[3])) /
             h.mass;
    }
    if (s_.device.lag > 0.0) d[4] = (command - z[4]) / s_.device.lag;
    return d;
  }

  SimulationSettings s_;
  State z_;
  int way_ = 0;
};

TEST(SimulatedDevice, FollowsAFineIntegrationThroughStickAndSlip) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int n = 0; n < 16; ++n) {
    SimulationSettings settings =
        bare(0.05 + 0.3 * any(random), 0.5 * any(random), n % 4 == 0 ? 0.0 : 0.4 * any(random));
    if (n % 3 != 0) settings.hand = handPreset(n % 2 == 0 ? "relaxed" : "firm");
    if (n % 6 == 5) settings.hand->grip_stiffness = settings.hand->grip_damping = 0.0;
    if (n % 5 == 4) settings.device.lag = 1e-3;
    settings.rate = n % 2 == 0 ? 1000.0 : 250.0;
    const int ticks = 200;
    Path path;
    Vec3 place(0.0);
    for (int k = 0; k <= ticks; ++k) {
      path.push_back({k / settings.rate, place});
      place += Vec3(2e-3 * (any(random) - 0.5), 0.0, 0.0);
    }
    SimulatedDevice device(settings, path);
    device.open();
    FineAxis fine(settings, 0.0);
    DeviceState reading;
    double worst = 0.0;
    for (int k = 0; k < ticks; ++k) {
      const std::size_t row = static_cast<std::size_t>(k);
      ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
      worst = std::max(worst, std::fabs(device.position().x - fine.x()));
      const double force = k % 7 < 5 ? 3.0 * (any(random) - 0.5) : 0.0;
      ASSERT_EQ(device.write(Vec3(force, 0.0, 0.0)), DeviceStatus::kOk);
      const double rate = (path[row + 1].position.x - path[row].position.x) * settings.rate;
      fine.go(force, path[row].position.x, rate, 1.0 / settings.rate, 5000);
    }
    // The fine steps are up to 0.8 us. A stop is found with an error of second order in the step,
    // times some um/s^2; and a slip begins up to one step late, which is an error of second order
    // too.
    EXPECT_LT(worst, settings.device.friction > 0.0 ? 1e-9 : 1e-12) << n;
  }
}

TEST(SimulatedDevice, EnergyBalances) {
  // No formula here covers a rigid hand at rest: motor = friction + viscous + kinetic + the hand's
  // share, and that share is the integral of the hand's own force, summed finely.
  SimulationSettings settings = bare(0.2, 0.8, 0.25);
  settings.push = Vec3(0.1, 0.0, 0.0);
  SimulatedDevice device(settings, still(10.0));
  device.open();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  DeviceState reading;
  double motor = 0.0;
  double push = 0.0;
  Vec3 before(0.0);
  Vec3 held(0.0);
  double most = 0.0;
  for (int k = 0; k < 4000; ++k) {
    ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
    motor += glm::dot(held, device.position() - before);
    push += glm::dot(settings.push, device.position() - before);
    before = device.position();
    if (k % 20 == 0) held = Vec3(any(random), any(random), 0.1 * any(random));
    ASSERT_EQ(device.write(held), DeviceStatus::kOk);
    const DeviceWork work = device.work();
    most = std::max(most, std::fabs(work.motor));
    ASSERT_NEAR(work.motor, motor, 1e-12 * (1.0 + most)) << k;
    ASSERT_NEAR(work.push, push, 1e-12 * (1.0 + most)) << k;
    // Nobody holds the device: no energy is given.
    ASSERT_NEAR(work.given(), 0.0, 1e-11 * (1.0 + most)) << k;
  }
  EXPECT_GT(device.work().friction, 0.1);
  EXPECT_GT(device.work().viscous, 0.1);
}

// A hand that presses slowly holds a device where friction and force are equal except for rounding.
// There each search for an event used to find one that the next search did not find, and reading
// went on for hours.
TEST(SimulatedDevice, WhereFrictionAndForceAreEqualButForRoundingItGoesOn) {
  std::mt19937 random(11);
  const auto any = [&](double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random);
  };
  for (int i = 0; i < 80; ++i) {
    const auto presets = devicePresets();
    const auto hands = handPresets();
    SimulationSettings settings;
    settings.device = presets[static_cast<std::size_t>(i) % presets.size()].model();
    settings.hand = handPreset(hands[static_cast<std::size_t>(i) % hands.size()].name);
    SCOPED_TRACE(std::to_string(i));
    // The device is pressed from inside onto a bowl of 30 mm.
    const double stiffness = any(200.0, 1500.0);
    const Vec3 to(any(-0.05, 0.05), any(-0.05, 0.05), any(-0.05, 0.05));
    SimulatedDevice device(settings, Path{{0.0, Vec3(0.0)}, {any(0.3, 1.0), to}, {1.1, to}});
    device.open();
    DeviceState reading;
    int ticks = 0;
    while (device.read(reading) == DeviceStatus::kOk) {
      const double out = glm::length(reading.position) - 0.03;
      Vec3 force(0.0);
      if (out > 0.0) force = -(stiffness * out / (out + 0.03)) * reading.position;
      ASSERT_EQ(device.write(force), DeviceStatus::kOk);
      ASSERT_TRUE(isFinite(reading.position));
      ++ticks;
    }
    EXPECT_GT(ticks, 1000);
  }
}

TEST(SimulatedDevice, AHandBringsItWhereItIsToldToBe) {
  SimulationSettings settings;
  settings.device = devicePreset("omega_3").model();
  settings.device.friction = 0.0;
  settings.hand = handPreset("relaxed");
  const Vec3 goal(0.01, -0.02, 0.005);
  SimulatedDevice device(settings, Path{{0.0, Vec3(0.0)}, {0.2, goal}, {3.0, goal}});
  device.open();
  run(device, 2900, [](int) { return Vec3(0.0); });
  EXPECT_LT(glm::length(device.position() - goal), 1e-9);
  EXPECT_LT(glm::length(device.handPosition() - goal), 1e-9);
  // The device gave the hand no energy: the energy that it lost came from the hand.
  EXPECT_LT(device.work().given(), 0.0);
}

TEST(SimulatedDevice, EndsWithItsPathAndStartsAnew) {
  SimulationSettings settings = bare(0.2, 0.5, 0.1);
  SimulatedDevice device(settings, still(0.01));
  std::array<Vec3, 2> ends;
  for (Vec3& end : ends) {
    device.open();
    DeviceState reading;
    int readings = 0;
    while (device.read(reading) == DeviceStatus::kOk) {
      EXPECT_NEAR(reading.time, readings * 1e-3, 1e-15);
      ++readings;
      ASSERT_EQ(device.write(Vec3(1.0, 2.0, -1.0)), DeviceStatus::kOk);
    }
    EXPECT_EQ(readings, 11);
    end = device.position();
    device.close();
    EXPECT_EQ(device.read(reading), DeviceStatus::kDisconnected);
    EXPECT_EQ(device.write(Vec3(0.0)), DeviceStatus::kDisconnected);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(SimulatedDevice, InRealTimeReadingsAreOfWhenTheyWereAskedFor) {
  SimulationSettings settings = bare(0.2, 0.0);
  settings.realtime = true;
  SimulatedDevice device(settings, still(0.05));
  std::atomic<bool> stop{false};
  double last = -1.0;
  bool falls = false;
  double worst = 0.0;
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& reading) {
        falls = falls || reading.time < last;
        last = reading.time;
        // 5 m/s^2 since the first tick.
        worst = std::max(worst, std::fabs(reading.position.x - 2.5 * last * last));
        return Vec3(1.0, 0.0, 0.0);
      },
      {.realtime = true, .rate = 1000.0, .watchdog = 1.0}, stop);
  EXPECT_EQ(report.exit, ServoExit::kEnd);
  EXPECT_FALSE(falls);
  EXPECT_LE(last, 0.05 + 1e-6);
  // Between the reading and its answer nothing moves: each step depends on the force that was held,
  // however long it took.
  EXPECT_LT(worst, 1e-12);
}

TEST(SimulatedDevice, ReadingAndWritingNeverAllocate) {
  SimulationSettings settings;
  settings.device = devicePreset("falcon").model();
  settings.device.lag = 2e-4;
  settings.hand = handPreset("firm");
  settings.delay = 3;
  SimulatedDevice device(settings, formula(StrokePath{.to = Vec3(0.02, 0.0, 0.01)}, 1000.0));
  device.open();
  DeviceState reading;
  const testing::AllocGuard guard;
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(device.read(reading), DeviceStatus::kOk);
    ASSERT_EQ(device.write(-200.0 * reading.position), DeviceStatus::kOk);
  }
  EXPECT_EQ(guard.violations(), 0);
}

TEST(SimulatedDevice, RefusesWhatCannotBe) {
  const auto make = [](const SimulationSettings& settings, Path path) {
    return SimulatedDevice(settings, std::move(path));
  };
  SimulationSettings settings = bare(0.2, 0.5);
  EXPECT_THROW(make(settings, {}), Error);
  EXPECT_THROW(make(settings, {{1.0, Vec3(0.0)}, {1.0, Vec3(0.0)}}), Error);
  EXPECT_THROW(make(settings, {{0.0, Vec3(kInfinity)}}), Error);
  settings.rate = 0.5;
  EXPECT_THROW(make(settings, still(1.0)), Error);
  settings.rate = 1000.0;
  settings.delay = SimulatedDevice::kMostDelay + 1;
  EXPECT_THROW(make(settings, still(1.0)), Error);
  settings.delay = 0;
  settings.push = Vec3(std::nan(""));
  EXPECT_THROW(make(settings, still(1.0)), Error);
  EXPECT_THROW(make(bare(0.0, 0.5), still(1.0)), Error);
  EXPECT_THROW(make(bare(0.2, 0.5, -1.0), still(1.0)), Error);
}

TEST(DevicePresets, AreFoundByNameAndSayWhatIsKnown) {
  for (const DevicePreset& each : devicePresets()) {
    const DeviceModel model = devicePreset(each.name).model();
    EXPECT_NO_THROW(check(model)) << each.name;
    EXPECT_EQ(model.name, each.name);
    EXPECT_TRUE(model.workspace.isBounded());
    for (const Quantity& quantity : {each.mass, each.damping, each.friction, each.encoder,
                                     each.max_force, each.width, each.height, each.depth}) {
      EXPECT_GT(quantity.value, 0.0) << each.name;
      EXPECT_FALSE(quantity.source.empty()) << each.name;
    }
    // No source states the damping of any of them.
    EXPECT_EQ(markOf(each.damping.known), " (assumed)") << each.name;
  }
  const DeviceModel excalibur = devicePreset("excalibur").model();
  EXPECT_EQ(excalibur.max_force, 100.0);
  EXPECT_EQ(excalibur.encoder, 8e-6);
  EXPECT_EQ(excalibur.workspace.size(), Vec3(0.3, 0.3, 0.2));
  for (const HandPreset& each : handPresets()) {
    ASSERT_TRUE(handPreset(each.name).has_value());
    EXPECT_NO_THROW(check(*handPreset(each.name)));
  }
  EXPECT_FALSE(handPreset("none").has_value());
  EXPECT_THROW((void)devicePreset("omni"), Error);
  EXPECT_THROW((void)handPreset("iron"), Error);
}

}  // namespace
}  // namespace palpate::devices
