// A Falcon in a closed loop, through the usual libusb: the stiffest wall it holds, and a complete
// path through a scene.

#ifdef PALPATE_LIBUSB

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <utility>

#include "devices/falcon_rig.h"
#include "folders/folders.h"
#include "palpate/devices/device.h"
#include "palpate/devices/path.h"
#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"

namespace palpate::devices {
namespace {

const std::atomic<bool> kNeverStop{false};

/// Checks that the last force is zero, and that the kernel holds no transfer.
void expectLetGo(Rig& rig) {
  EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  EXPECT_EQ(rig.usb.pending(), 0);
}

/// [N/m] of a wall at which a mass neither comes to rest nor oscillates with growing amplitude:
/// there the exact discrete system, in which the force computed from the reading at the end of one
/// turn is held over the next turn, has a determinant of 1.
double limitOf(double mass, double damping) {
  constexpr double kPeriod = 1e-3;  // [s]
  const double e = std::exp(-damping * kPeriod / mass);
  const double place_by_speed = (1.0 - e) * mass / damping;
  const double place_by_force = (kPeriod - place_by_speed) / damping;
  const double speed_by_force = (1.0 - e) / damping;
  return (1.0 - e) / (place_by_speed * speed_by_force - e * place_by_force);
}

TEST(FalconLoop, AWallIsHeldWithoutAHiddenSample) {
  constexpr double kMass = 0.02;    // [kg]
  constexpr double kDamping = 0.2;  // [Ns/m]
  const double limit = limitOf(kMass, kDamping);
  // One more sample of delay would make it a third of that: b / (T / 2 + T).
  std::printf("growth changes sign at %.1f N/m; b / (T / 2): %.1f N/m\n", limit, kDamping / 0.5e-3);
  EXPECT_NEAR(limit, kDamping / 0.5e-3, 0.02 * limit);
  for (const double share : {0.98, 1.02}) {
    FalconCalibration calibration;
    calibration.radians_per_count =
        1e-5;  // so that the steps of the encoders do not hide the growth
    Rig rig({}, calibration);
    rig.emulator.radians_per_count = calibration.radians_per_count;
    rig.emulator.mass = kMass;
    rig.emulator.damping = kDamping;
    rig.device.open();
    rig.emulator.place(Vec3(0.0, 0.0, 0.130));
    DeviceState state;
    (void)rig.turn(state);
    rig.emulator.place(Vec3(0.0, 0.0, 0.130));
    double early = 0.0;
    double late = 0.0;
    for (int i = 0; i < 2000; ++i) {
      DeviceStatus status = DeviceStatus::kStale;
      for (int k = 0; k < 10 && status == DeviceStatus::kStale; ++k)
        status = rig.device.read(state);
      ASSERT_EQ(status, DeviceStatus::kOk) << i;
      (void)rig.device.write(-share * limit * state.position);
      const double size = std::abs(state.position.z);
      if (i >= 100 && i < 300) early = std::max(early, size);
      if (i >= 1800) late = std::max(late, size);
    }
    // The rate is about 0.1 / s.
    EXPECT_EQ(late > early, share > 1.0) << share << ": " << early << " then " << late << " m";
  }
}

/// [m] The largest excursion of the grip about its mean, while a hand pushes it steadily against a
/// wall of `stiffness` [N/m]: early and late in a run with scene, session, servo loop, driver and
/// libusb. The grip is displaced by 2 mm when the push is there.
std::pair<double, double> swingAt(double stiffness, double mass, double damping) {
  SceneDescription scene = parseScene(
      "{palpate: 1, length: m, materials: {wall: {stiffness: " + std::to_string(stiffness) +
          " N/m}}, layers: [{name: wall, wall: wall, inside: {half_space: {point: [0, 0, 0], "
          "normal: [0, 0, 1]}}}]}",
      "wall");
  Session session(compile(std::move(scene)));
  FalconCalibration calibration;
  calibration.radians_per_count = 1e-5;  // so that the steps of the encoders do not hide the growth
  Rig rig({}, calibration);
  rig.emulator.radians_per_count = calibration.radians_per_count;
  rig.emulator.mass = mass;
  rig.emulator.damping = damping;
  rig.emulator.place(Vec3(0.0, 0.0, 0.125));
  // The push grows slowly, after the ramp of the force; it holds the grip 5 mm deep, so that it
  // never leaves the wall.
  rig.emulator.hand = [&](const Vec3&) {
    const double t = 1e-9 * static_cast<double>(rig.emulator.now());
    return Vec3(0.0, 0.0, -5e-3 * stiffness * std::clamp(t - 1.0, 0.0, 1.0));
  };
  std::atomic<bool> stop{false};
  double early = 0.0;
  double late = 0.0;
  int n = 0;
  const auto tick = [&](const DeviceState& reading) {
    ++n;
    if (n == 3000) rig.emulator.place(rig.emulator.position() + Vec3(0.0, 0.0, 2e-3));
    const double swing = std::abs(reading.position.z + 5e-3);
    if (n >= 3100 && n < 3300) early = std::max(early, swing);
    if (n >= 4800) late = std::max(late, swing);
    if (n == 5000) stop = true;
    return session.step(reading, DeviceFrame::kDevice).force;
  };
  const ServoReport report = runServo(rig.device, tick, {}, stop);
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.fault, SafetyFault::kNone);
  EXPECT_GT(early, 1e-3);
  return {early, late};
}

TEST(FalconLoop, AWallOfASceneGrowsFromTheExactLimitOnThroughTheWholeChain) {
  constexpr double kMass = 0.02;    // [kg]
  constexpr double kDamping = 0.2;  // [Ns/m]
  const double limit = limitOf(kMass, kDamping);
  for (const double share : {0.98, 1.02}) {
    const auto [early, late] = swingAt(share * limit, kMass, kDamping);
    std::printf("  %.2f of %.1f N/m: a swing of %.3f mm becomes one of %.3f mm\n", share, limit,
                1e3 * early, 1e3 * late);
    EXPECT_EQ(late > early, share > 1.0) << share;
  }
}

TEST(FalconLoop, TheWholeChainInByTheMouthAlongTheWallAndOut) {
  // data/scenes/container.yaml, in the device's own space: from 30 mm above the bowl's center down
  // to its bottom, and back.
  const ScenePtr scene = compile(readScene(test::sourceFolder() + "/data/scenes/container.yaml"));
  Session session(scene);
  Rig rig;
  rig.emulator.damping = 7.0;
  rig.emulator.place(Vec3(0.005, 0.0, 0.125 + 0.030));
  std::atomic<bool> stop{false};
  constexpr double kWay = 2.0;  // [s] down, and the same up
  rig.emulator.hand = [&](const Vec3& p) {
    const double t = 1e-9 * static_cast<double>(rig.emulator.now()) - 0.6;
    const double down = std::clamp(t < kWay ? t / kWay : 2.0 - t / kWay, 0.0, 1.0);
    const Vec3 target(0.005, 0.0, 0.125 + 0.030 - 0.090 * down);
    if (t > 2.0 * kWay + 0.2) stop = true;
    return 250.0 * (target - p);
  };
  Path path;
  std::vector<Vec3> asked;
  std::vector<SessionTick> felt;
  double most_inside = 0.0;
  double worst = 0.0;
  SessionTick now;
  const auto tick = [&](const DeviceState& reading) {
    now = session.step(reading, DeviceFrame::kDevice);
    path.push_back({reading.time, reading.position});
    asked.push_back(now.force);
    felt.push_back(now);
    if (scene->regions()[now.result.region].name == "liquid" && now.result.contact) {
      most_inside = std::max(most_inside, now.force.z);
    }
    return now.force;
  };
  const ServoReport report = runServo(rig.device, tick, {}, stop, [&](const ServoTurn& turn) {
    const double off = glm::length(rig.emulator.felt - turn.written);
    // Half a count of each motor is 0.5e-4 Nm, at 20 to 30 rad/m; and the arms' pose comes from the
    // encoders, which changes a force by less than two parts in a thousand.
    const double allowed = 3e-3 + 2e-3 * glm::length(turn.written);
    worst = std::max(worst, off / allowed);
  });
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.fault, SafetyFault::kNone);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(most_inside, 2.0) << "the bottom, from inside";
  std::vector<std::string> regions;
  for (const SessionTick& t : felt) {
    const std::string& name = scene->regions()[t.result.region].name;
    if (regions.empty() || regions.back() != name) regions.push_back(name);
  }
  EXPECT_EQ(regions, (std::vector<std::string>{"outside", "liquid", "outside"}));
  // The same hand with the virtual device: the same forces, bit for bit.
  Session again(scene);
  VirtualDevice device(path, DeviceFrame::kDevice);
  std::size_t at = 0;
  (void)again.run(device, kNeverStop, [&](const SessionTick& t, const HapticRenderer&) {
    ASSERT_EQ(t.force, asked[at]) << at;
    ++at;
  });
  EXPECT_EQ(at, asked.size());
  expectLetGo(rig);
}

}  // namespace
}  // namespace palpate::devices

#endif
