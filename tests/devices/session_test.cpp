// A hand in a scene, with a device that has its own axes, scale and clutch.

#include "palpate/devices/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

constexpr double kTick = 1e-3;  // [s]

ScenePtr sceneOf(const std::string& device) {
  return compile(parseScene(R"(
palpate: 1
length: mm
materials:
  wall: {stiffness: 800 N/m, friction: {static: 0.3, kinetic: 0.2}}
  oil: {viscosity: 2 N.s/m}
layers:
  - {name: bath, inside: {box: {center: [0, 0, -10], size: [80, 80, 20]}}, content: oil, wall: absent}
  - {name: ball, inside: {sphere: {center: [0, 0, -12], radius: 8}}, wall: wall}
)" + device,
                            "session.yaml"));
}

/// A hand that wanders around the ball, in a device's coordinates [m].
std::vector<Vec3> wanderings(int ticks, double scale) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<Vec3> path;
  Vec3 p(0.0, 0.0, 0.005);
  Vec3 goal = p;
  for (int n = 0; n < ticks; ++n) {
    if (n % 80 == 0)
      goal = Vec3(0.008 * any(random), 0.008 * any(random), -0.012 + 0.01 * any(random));
    p += 0.02 * (goal - p);
    path.push_back(p / scale);
  }
  return path;
}

TEST(Session, AMappedDeviceFeelsTheWorldThroughScaleAndTurn) {
  const ScenePtr scene = sceneOf(
      "device: {offset: [1, -2, 0.5], rotate: {axis: [0, 0, 1], degrees: 90}, scale: 0.25, force: "
      "3}\n");
  const DeviceMapping& mapping = scene->device();
  Session mapped(scene);
  Session plain(scene);
  double at_hand = 0.0;
  double in_world = 0.0;
  double most = 0.0;
  Vec3 last_device(0.0);
  Vec3 last_world(0.0);
  int n = 0;
  for (const Vec3& device : wanderings(4000, 0.25)) {
    const double t = n * kTick;
    // By hand: a rotation by 90 degrees about z maps x to y and y to -x.
    const Vec3 world = Vec3(0.001, -0.002, 0.0005) + 0.25 * Vec3(-device.y, device.x, device.z);
    const SessionTick a = mapped.step({.time = t, .position = device}, DeviceFrame::kDevice);
    const SessionTick b = plain.step({.time = t, .position = world}, DeviceFrame::kWorld);
    ASSERT_LT(glm::length(a.hip.position - world), 1e-15);
    // 800 N/m times the rounding of positions, and 2 N s/m times that over a tick.
    ASSERT_LT(glm::length(a.result.force - b.result.force), 1e-9) << n;
    const Vec3& f = b.result.force;
    ASSERT_LT(glm::length(a.force - 3.0 * Vec3(f.y, -f.x, f.z)), 1e-8) << n;
    if (n > 0) {
      at_hand += glm::dot(a.force, device - last_device);
      in_world += glm::dot(b.force, world - last_world);
    }
    most = std::max(most, glm::length(f));
    last_device = device;
    last_world = world;
    ++n;
  }
  EXPECT_GT(most, 1.0);
  EXPECT_DOUBLE_EQ(mapping.workAtHand(), 12.0);
  EXPECT_DOUBLE_EQ(mapping.stiffnessAtHand(), 0.75);
  EXPECT_NEAR(at_hand, 12.0 * in_world, 1e-9 * std::fabs(at_hand) + 1e-12);
}

TEST(Session, WithoutAClutchInTheSceneAButtonDoesNothing) {
  const ScenePtr scene = sceneOf("");
  Session session(scene);
  for (int n = 0; n < 100; ++n) {
    const Vec3 p(0.0, 0.0, -1e-4 * n);
    const SessionTick tick =
        session.step({.time = n * kTick, .position = p, .velocity = Vec3(0.0), .buttons = ~0U},
                     DeviceFrame::kDevice);
    EXPECT_EQ(tick.hip.position, p);
    EXPECT_EQ(tick.force, tick.result.force);
  }
}

TEST(Session, ContentsChangeWhenTheirTimeComes) {
  const ScenePtr scene = sceneOf("");
  SessionSettings settings;
  settings.changes = {{0.05, 1, {.viscosity = 6.0}}, {0.1, 1, {}}};
  ASSERT_EQ(scene->regions()[1].name, "bath");
  Session session(scene, settings);
  for (int n = 0; n < 150; ++n) {
    // The hand moves beside the ball at 10 mm/s.
    const SessionTick tick = session.step(
        {.time = n * kTick, .position = Vec3(0.03, -1e-5 * n, -0.01)}, DeviceFrame::kWorld);
    if (n < 20) continue;  // until the content has faded in
    EXPECT_NEAR(tick.force.y, (n >= 50 && n < 100 ? 6.0 : 2.0) * 0.01, 1e-12) << n;
  }
  const auto code = [&](const std::vector<ContentEvent>& changes) {
    SessionSettings wrong;
    wrong.changes = changes;
    try {
      const Session refused(scene, wrong);
    } catch (const Error& error) {
      return error.problem().code;
    }
    return std::string("none");
  };
  EXPECT_EQ(code({{0.1, 1, {}}, {0.05, 1, {}}}), "session.changes");
  EXPECT_EQ(code({{0.1, 77, {}}}), "session.changes");
  EXPECT_EQ(code({{0.1, 1, {.viscosity = -1.0}}}), "session.changes");
  SessionSettings wrong;
  wrong.clutch_button = 32;
  EXPECT_THROW(Session(scene, wrong), Error);
}

TEST(Session, TheForceBeforeItsLimitsIsThatOfASessionWithoutThem) {
  const ScenePtr scene = sceneOf("");
  Session plain(scene);
  SessionSettings settings;
  settings.renderer.limits.max_force = 0.3;
  Session limited(scene, settings);
  int shortened = 0;
  int n = 0;
  for (const Vec3& p : wanderings(3000, 1.0)) {
    const DeviceState reading{.time = kTick * n++, .position = p};
    const SessionTick free = plain.step(reading, DeviceFrame::kWorld);
    const SessionTick held = limited.step(reading, DeviceFrame::kWorld);
    ASSERT_EQ(free.unlimited, free.result.force);
    ASSERT_EQ(held.unlimited, free.unlimited) << n;
    ASSERT_EQ(held.number, static_cast<std::uint64_t>(n - 1));
    shortened += held.unlimited != held.result.force ? 1 : 0;
  }
  EXPECT_GT(shortened, 100);
  const SessionTick broken =
      plain.step({.time = 100.0, .position = Vec3(std::numeric_limits<double>::quiet_NaN())},
                 DeviceFrame::kWorld);
  EXPECT_EQ(broken.unlimited, Vec3(0.0));
}

TEST(Session, ABrokenReadingGivesNoForceAndChangesNothing) {
  const ScenePtr scene = sceneOf("device: {clutch: true}\n");
  Session session(scene);
  Session sound(scene);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double t = 0.0;
  for (int n = 0; n < 400; ++n) {
    const Vec3 p(0.0, 0.0, -2e-5 * n);
    t += kTick;
    const SessionTick a = session.step({.time = t, .position = p}, DeviceFrame::kDevice);
    const SessionTick b = sound.step({.time = t, .position = p}, DeviceFrame::kDevice);
    EXPECT_LT(glm::length(a.result.proxy - b.result.proxy), 1e-12);
    if (n % 50 != 10) continue;
    t += kTick;
    const SessionTick bad = session.step(
        {.time = t, .position = Vec3(nan, 0.0, 0.0), .velocity = Vec3(0.0), .buttons = 1U},
        DeviceFrame::kDevice);
    EXPECT_EQ(bad.force, Vec3(0.0));
  }
}

TEST(Session, RunGoesThroughTheWholePathAndStepNeverAllocates) {
  const ScenePtr scene = sceneOf("device: {offset: [0, 0, 2], scale: 0.5}\n");
  Path path;
  for (const Vec3& p : wanderings(500, 1.0))
    path.push_back({kTick * static_cast<double>(path.size()), p});
  for (const DeviceFrame frame : {DeviceFrame::kWorld, DeviceFrame::kDevice}) {
    Session session(scene);
    VirtualDevice device(path, frame);
    const std::atomic<bool> stop{false};
    std::size_t heard = 0;
    const ServoReport report =
        session.run(device, stop, [&](const SessionTick& tick, const HapticRenderer& renderer) {
          const Vec3 wanted = frame == DeviceFrame::kWorld
                                  ? path[heard].position
                                  : Vec3(0.0, 0.0, 0.002) + 0.5 * path[heard].position;
          EXPECT_LT(glm::length(tick.hip.position - wanted), 1e-15);
          EXPECT_EQ(&renderer, &session.renderer());
          EXPECT_NEAR(tick.dt, kTick, 1e-12);
          ++heard;
        });
    EXPECT_EQ(report.exit, ServoExit::kEnd);
    EXPECT_EQ(heard, path.size());
  }
  Session session(scene);
  (void)session.step({.time = 0.0, .position = path[0].position}, DeviceFrame::kDevice);
  const testing::AllocGuard guard;
  for (const PathPoint& point : path) {
    (void)session.step({.time = 1.0 + point.t, .position = point.position}, DeviceFrame::kDevice);
  }
  EXPECT_EQ(guard.violations(), 0);
}

TEST(Session, EachTickButTheFirstMayBeACheckpoint) {
  SessionSettings settings;
  settings.checkpoint_every = 1;
  Session session(sceneOf(""), settings);
  for (int n = 0; n < 4; ++n) {
    const SessionTick tick =
        session.step({.time = kTick * n, .position = Vec3(0.0, 0.0, 0.01)}, DeviceFrame::kWorld);
    EXPECT_EQ(tick.is_checkpoint, n > 0) << n;
  }
}

TEST(Session, SettingsThatCannotBeAreRefused) {
  const ScenePtr scene = compile(parseScene(
      "{palpate: 1, length: mm, materials: {g: {stiffness: 1 N/mm}}, layers: [{name: ball, inside: "
      "{sphere: {center: [0, 0, 0], radius: 40}}, wall: g}]}",
      "settings.yaml"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto is_refused = [&](const auto& change) {
    SessionSettings settings;
    change(settings);
    try {
      const Session session(scene, settings);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(is_refused([](SessionSettings&) {}));
  for (const double rate : {0.0, -5.0, nan, 1e6}) {
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.servo.rate = rate; })) << rate;
  }
  for (const double bad : {-1.0, nan}) {
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.servo.watchdog = bad; }));
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.servo.recovery = bad; }));
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.renderer.limits.max_force = bad; }));
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.renderer.limits.max_growth = bad; }));
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.renderer.limits.ramp = bad; }));
    EXPECT_TRUE(is_refused([&](SessionSettings& s) { s.renderer.limits.period = bad; }));
  }
  EXPECT_TRUE(is_refused([](SessionSettings& s) { s.renderer.limits.period = 0.0; }));
  EXPECT_TRUE(
      is_refused([](SessionSettings& s) { s.renderer.kind = static_cast<RendererKind>(7); }));
  EXPECT_TRUE(is_refused(
      [](SessionSettings& s) { s.velocity.estimator = static_cast<VelocityEstimator>(7); }));
  EXPECT_TRUE(is_refused([](SessionSettings& s) { s.servo.elevate = static_cast<Elevate>(7); }));
}

}  // namespace
}  // namespace palpate::devices
