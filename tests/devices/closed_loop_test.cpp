// The whole program in a closed loop: device, hand, session and renderer on a flat wall. It must
// become unstable where the theory says so.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "palpate/devices/device_presets.h"
#include "palpate/devices/session.h"
#include "palpate/devices/simulated_device.h"
#include "palpate/devices/stability.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

ScenePtr flatWall(double stiffness, double damping) {
  std::ostringstream text;
  text.precision(17);
  text << "palpate: 1\nlength: m\nmaterials:\n  wall: {stiffness: " << stiffness
       << " N/m, damping: " << damping
       << " N.s/m}\nlayers:\n  - {name: wall, inside: {half_space: {point: [0, 0, 0], normal: [0, "
          "0, 1]}}, wall: wall}\n";
  return compile(parseScene(text.str(), "flat.yaml"));
}

/// The linear part of a preset.
LoopModel linearLoop(const std::string& name, const std::string& hand, double period, int delay) {
  LoopModel loop;
  loop.device = devicePreset(name).model();
  loop.device.friction = 0.0;
  loop.device.encoder = 0.0;
  loop.device.max_force = kInfinity;
  loop.hand = handPreset(hand);
  loop.period = period;
  loop.delay = delay;
  return loop;
}

constexpr double kDepth = 2e-3;  // [m] depth at which the device rests in the wall

/// The path of a hand that presses the device to that depth: it gets there within a second, so
/// slowly that no oscillation starts, except for the last percent, which it covers at once.
Path pressPath(const LoopModel& loop, const WallModel& wall, double kick, double end) {
  const HandModel& hand = *loop.hand;
  const double springs =
      hand.hasGrip() ? hand.stiffness * hand.grip_stiffness / (hand.stiffness + hand.grip_stiffness)
                     : hand.stiffness;
  const double goal = -kDepth * (1.0 + wall.stiffness / springs);
  Path path;
  constexpr int kRows = 500;
  for (int n = 0; n <= kRows; ++n) {
    const double share = 0.5 - 0.5 * std::cos(std::numbers::pi * n / kRows);
    path.push_back({kick * n / kRows, Vec3(0.0, 0.0, 0.99 * share * goal)});
  }
  path.push_back({kick + 0.5 * loop.period, Vec3(0.0, 0.0, goal)});
  path.push_back({end, Vec3(0.0, 0.0, goal)});
  return path;
}

/// [-] The factor by which an oscillation about the rest position grows in a tick, in a run of the
/// whole program: from the least-squares fit of x[k+1] = a1 x[k] + a2 x[k-1] to the run's last
/// half; for two conjugate roots, -a2 is the square of their magnitude.
double growthInARun(const LoopModel& loop, const WallModel& wall) {
  SimulationSettings settings{
      .device = loop.device, .hand = loop.hand, .rate = 1.0 / loop.period, .delay = loop.delay};
  // A hand's own modes must decay first: the slowest, 14 / s for a relaxed hand, falls to 1e-6
  // within a second. If the oscillation grows faster than that, the run need not be so long.
  const double tenfold = std::log(10.0) / std::fabs(std::log(growthOf(loop, wall)));
  const double longest = loop.hand ? std::max(1000.0, 2.0 / loop.period) : 1000.0;
  const int ticks = static_cast<int>(std::clamp(tenfold, 1000.0, longest));
  const int before = loop.hand ? static_cast<int>(std::lround(1.0 / loop.period)) : 0;
  const double end = (before + ticks - 0.5) * loop.period;
  // The device starts 1 % off the rest position: contact is not lost while this offset grows by
  // less than 100 times.
  Path path = {{0.0, Vec3(0.0, 0.0, -0.99 * kDepth)}, {end, Vec3(0.0, 0.0, -kDepth)}};
  if (loop.hand) {
    path = pressPath(loop, wall, before * loop.period, end);
  } else {
    settings.push = Vec3(0.0, 0.0, -wall.stiffness * kDepth);
  }
  SimulatedDevice device(settings, path, DeviceFrame::kWorld);

  Session session(flatWall(wall.stiffness, wall.damping));
  const std::atomic<bool> stop{false};
  std::vector<double> x;
  x.reserve(static_cast<std::size_t>(before + ticks));
  const auto half = static_cast<std::size_t>(before + ticks / 2);
  bool is_lost = false;
  const ServoReport report = session.run(device, stop, [&](const SessionTick& tick, const auto&) {
    if (tick.number >= half && !tick.result.contact) is_lost = true;
    x.push_back(tick.hip.position.z + kDepth);
  });
  EXPECT_EQ(report.exit, ServoExit::kEnd);
  EXPECT_FALSE(is_lost) << "contact was lost: " << loop.device.name << ", " << ticks << " ticks";
  double s11 = 0.0;
  double s12 = 0.0;
  double s22 = 0.0;
  double r1 = 0.0;
  double r2 = 0.0;
  for (std::size_t k = half + 1; k + 1 < x.size(); ++k) {
    s11 += x[k] * x[k];
    s12 += x[k] * x[k - 1];
    s22 += x[k - 1] * x[k - 1];
    r1 += x[k + 1] * x[k];
    r2 += x[k + 1] * x[k - 1];
  }
  return -(s11 * r2 - s12 * r1) / (s11 * s22 - s12 * s12);
}

struct Loop {
  std::string device;
  std::string hand;
  double period;
  int delay;
  double damping;  // [N s/m] damping of the wall
};

void expectTheLimit(const Loop& each) {
  const LoopModel loop = linearLoop(each.device, each.hand, each.period, each.delay);
  const double limit = largestStiffness(loop, each.damping);
  ASSERT_GT(limit, 0.0);
  const std::string what = each.device + ", hand " + each.hand + ", T " +
                           std::to_string(each.period) + ", delay " + std::to_string(each.delay) +
                           ", damping " + std::to_string(each.damping) + ", limit " +
                           std::to_string(limit);
  EXPECT_LT(growthInARun(loop, {0.995 * limit, each.damping}), 1.0) << what;
  EXPECT_GT(growthInARun(loop, {1.005 * limit, each.damping}), 1.0) << what;
}

TEST(ClosedLoop, OfTheWholeProgramGrowsFromTheExactLimitOn) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  int count = 0;
  for (const DevicePreset& preset : devicePresets()) {
    for (const double period : {1e-3, 2.5e-4, 1e-4}) {
      for (int delay = 0; delay < 4; ++delay) {
        for (const char* hand : {"none", "relaxed", "firm"}) {
          const bool is_held = std::string(hand) != "none";
          if (!slow && is_held && (period != 1e-3 || delay > 1)) continue;
          expectTheLimit({std::string(preset.name), hand, period, delay, 0.0});
          if (::testing::Test::HasFatalFailure()) return;
          ++count;
        }
      }
    }
  }
  RecordProperty("loops", count);
}

TEST(ClosedLoop, AWallsDampingMovesTheLimitAsTheExactOneDoes) {
  for (const char* hand : {"none", "relaxed"}) {
    for (const double damping : {0.5, 2.0}) {
      for (int delay = 0; delay < 2; ++delay) {
        expectTheLimit({"falcon", hand, 1e-3, delay, damping});
        expectTheLimit({"excalibur", hand, 1e-3, delay, damping});
      }
    }
  }
}

TEST(ClosedLoop, OneSampleOfDelayMoreThanSaidWouldShow) {
  // With one more sample of delay the limit would be a third: at twice this third, a run without
  // that delay must not grow.
  const LoopModel loop = linearLoop("falcon", "none", 1e-3, 0);
  LoopModel later = loop;
  later.delay = 1;
  const double third = largestStiffness(later);
  EXPECT_LT(growthInARun(loop, {2.0 * third, 0.0}), 1.0);
  EXPECT_GT(growthInARun(later, {2.0 * third, 0.0}), 1.0);
}

TEST(ClosedLoop, WithAllOfTheDeviceTheLoopNeverAllocates) {
  SimulationSettings settings;
  settings.device = devicePreset("touch").model();
  settings.device.lag = 2e-4;
  settings.hand = handPreset("relaxed");
  settings.delay = 1;
  const PressPath press{.depth = 0.004, .clearance = 0.002};
  SimulatedDevice device(settings, formula(press, 1000.0), DeviceFrame::kWorld);
  Session session(flatWall(1000.0, 0.5));
  device.open();
  DeviceState reading;
  bool touched = false;
  const testing::AllocGuard guard;
  while (device.read(reading) == DeviceStatus::kOk) {
    const SessionTick tick = session.step(reading, DeviceFrame::kWorld);
    touched = touched || tick.result.contact;
    static_cast<void>(device.write(tick.force));
  }
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_TRUE(touched);
}

}  // namespace
}  // namespace palpate::devices
