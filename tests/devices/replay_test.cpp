// A random session with any device, clutch, estimator, limits, changes and faults: replayed from
// its record, from the start and from each state, it is the same bit for bit; and a difference is
// found.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "palpate/devices/record.h"
#include "palpate/scene/scene_file.h"
#include "support/temp_file.h"

namespace palpate::devices {
namespace {

/// `opens`: the opening force of the skin's port; empty for an open port, as the paper's renderer
/// requires.
SceneDescription describe(double stiffness,
                          const std::string& opens = ", opens_at: 0.7 N, back: 0.3 N") {
  return parseScene(R"(
palpate: 1
length: mm
materials:
  wall: {stiffness: )" + std::to_string(stiffness) +
                        R"( N/m, friction: {static: 0.3, kinetic: 0.2}}
  oil: {viscosity: 2 N.s/m}
  jelly: {viscosity: 1 N.s/m}
layers:
  - {name: bath, inside: {box: {center: [0, 0, -10], size: [80, 80, 20]}}, content: oil, wall: absent}
  - {name: ball, inside: {sphere: {center: [0, 0, -10], radius: 9}}, content: jelly, wall: wall}
  - {name: core, inside: {sphere: {center: [1, 0, -11], radius: 4}}, wall: wall}
ports:
  - {name: skin, between: [bath, ball])" +
                        opens + "}\n",
                    "replay.yaml");
}

/// Returns readings that were made beforehand, including faults.
class Readings final : public Device {
 public:
  Readings(std::vector<DeviceState> readings, std::vector<DeviceStatus> statuses, DeviceFrame frame)
      : readings_(std::move(readings)), statuses_(std::move(statuses)) {
    info_.max_force = 3.0;
    info_.frame = frame;
  }
  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override {
    if (next_ == readings_.size()) return DeviceStatus::kEnd;
    if (statuses_[next_] == DeviceStatus::kOk) out = readings_[next_];
    return statuses_[next_++];
  }
  [[nodiscard]] DeviceStatus write(const Vec3&) noexcept override { return DeviceStatus::kOk; }

 private:
  DeviceInfo info_;
  std::vector<DeviceState> readings_;
  std::vector<DeviceStatus> statuses_;
  std::size_t next_ = 0;
};

struct Case {
  SceneDescription description;
  ScenePtr scene;
  SessionSettings settings;
  DeviceFrame frame = DeviceFrame::kWorld;
  std::vector<DeviceState> readings;
  std::vector<DeviceStatus> statuses;

  explicit Case(unsigned seed) {
    std::mt19937 random(seed);
    const auto any = [&](double lo, double hi) {
      return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    const auto chance = [&](double share) { return any(0.0, 1.0) < share; };
    const bool is_paper = chance(0.3);
    description = is_paper ? describe(600.0, "") : describe(600.0);
    if (chance(0.5)) {
      frame = DeviceFrame::kDevice;
      description.device.scale = 0.5;
      description.device.rotation = rotationAbout(Vec3(0.0, 0.6, 0.8), any(-2.0, 2.0));
      description.device.offset = Vec3(0.01, -0.02, 0.0);
    }
    description.device.clutch = chance(0.5);
    scene = compile(description);
    settings.renderer.kind = is_paper ? RendererKind::kPaper : RendererKind::kConstraint;
    if (chance(0.5)) settings.renderer.limits.max_force = 0.5;
    if (chance(0.5)) settings.renderer.limits.max_growth = 20.0;
    settings.velocity.estimator = static_cast<VelocityEstimator>(random() % 3);
    settings.velocity.noise = 1e-5;
    settings.checkpoint_every = 1 + random() % 400;
    if (chance(0.5)) {
      ContentChange thick;
      thick.viscosity = 5.0;
      settings.changes = {{any(0.2, 0.5), 1, thick}, {any(0.5, 1.5), 2, thick}};
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Vec3 p(0.0, 0.0, 0.003);
    Vec3 goal = p;
    DeviceState now;
    for (int n = 0; n < 2000; ++n) {
      if (n % 90 == 0) goal = Vec3(any(-6e-3, 6e-3), any(-6e-3, 6e-3), any(-0.018, 0.004));
      p += 0.03 * (goal - p);
      now.time += chance(0.01) ? 0.0 : any(0.5e-3, 1.5e-3);
      const DeviceMapping& mapping = scene->device();
      now.position = frame == DeviceFrame::kDevice
                         ? glm::transpose(mapping.rotation) * (p - mapping.offset) / mapping.scale
                         : p;
      if (chance(0.01)) now.buttons ^= 1U;
      DeviceState reading = now;
      if (chance(0.005)) reading.position[n % 3] = nan;
      if (chance(0.003)) reading.time = nan;
      readings.push_back(reading);
      const bool is_stale = n > 0 && chance(0.02);
      statuses.push_back(is_stale ? DeviceStatus::kStale : DeviceStatus::kOk);
    }
  }

  void record(const std::string& file, const std::string& states) const {
    Session session(scene, settings);
    Readings device(readings, statuses, frame);
    RowFile rows(file, file);
    StateFile saved(states, states, "about");
    Recorder recorder({&rows, &saved}, {.ticks = 256, .states = 1, .waits = true});
    const std::atomic<bool> stop{false};
    const ServoReport report = session.run(device, stop, recorder);
    ASSERT_EQ(recorder.finish().ticks, report.ticks);
    ASSERT_TRUE(recorder.finish().failures.empty());
  }
};

TEST(Replay, IsTheSameFromTheStartAndFromAnyState) {
  std::uint64_t contacts = 0;
  std::uint64_t passed = 0;
  std::uint64_t held = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const Case drawn(seed);
    const testing::TempFolder folder;
    const std::string file = folder.path("r.npy");
    const std::string states = folder.path("r.states");
    ASSERT_NO_FATAL_FAILURE(drawn.record(file, states));
    RecordReader record(file);
    ASSERT_GT(record.size(), 1900U);
    {
      Session session(drawn.scene, drawn.settings);
      const ReplayReport report = replay(record, session, drawn.frame);
      EXPECT_EQ(report.compared, record.size());
      EXPECT_EQ(report.different, 0U)
          << seed << ": tick " << report.first->tick << ", " << report.first->what;
    }
    StateReader saved(states, "about");
    const std::uint64_t every = drawn.settings.checkpoint_every;
    ASSERT_EQ(saved.size(), (record.size() - 1) / every);
    std::mt19937 random(seed);
    for (int i = 0; i < 4; ++i) {
      const std::uint64_t from = every + random() % (record.size() - every);
      const auto state = saved.before(from);
      ASSERT_TRUE(state);
      ASSERT_EQ(state->ticks, from / every * every);
      Session session(drawn.scene, drawn.settings);
      ASSERT_TRUE(session.resume(*state));
      EXPECT_FALSE(session.ticks() == 0);
      record.seek(session.ticks());
      const ReplayReport report = replay(record, session, drawn.frame, from);
      EXPECT_EQ(report.compared, record.size() - from);
      EXPECT_EQ(report.different, 0U) << seed << " from " << from << ": tick " << report.first->tick
                                      << ", " << report.first->what;
      EXPECT_FALSE(session.resume(*state)) << "it has made ticks";
    }
    record.seek(0);
    TickRecord row;
    while (record.next(row)) {
      contacts += row.contact;
      passed += row.event_count;
      held += row.clutch;
    }
  }
  EXPECT_GT(contacts, 1000U);
  EXPECT_GT(passed, 10U);
  EXPECT_GT(held, 1000U);
}

TEST(Replay, WhatIsNotTheSameIsFoundWithItsSize) {
  Case drawn(3);
  drawn.settings = {};
  const testing::TempFolder folder;
  const std::string file = folder.path("r.npy");
  ASSERT_NO_FATAL_FAILURE(drawn.record(file, folder.path("r.states")));
  RecordReader record(file);
  SceneDescription harder = describe(660.0);
  harder.device = drawn.description.device;
  const ScenePtr other = compile(harder);
  Session session(other, drawn.settings);
  const ReplayReport report = replay(record, session, drawn.frame);
  ASSERT_TRUE(report.first);

  // Without replay(): both sessions side by side.
  Session before(drawn.scene, drawn.settings);
  Session after(other, drawn.settings);
  record.seek(0);
  TickRecord row;
  double most = 0.0;
  std::uint64_t first = record.size();
  while (record.next(row)) {
    const Vec3 a = before.step(readingOf(row), drawn.frame).result.force;
    const Vec3 b = after.step(readingOf(row), drawn.frame).result.force;
    if (a != b) first = std::min(first, row.tick);
    most = std::max(most, glm::length(a - b));
  }
  EXPECT_EQ(report.most_force, most);
  EXPECT_GT(most, 0.01);
  EXPECT_LE(report.first->tick, first);
  EXPECT_NE(report.first->what.find("force"), std::string::npos) << report.first->what;
}

TEST(Replay, RegionsAndPortsAreComparedByTheirNames) {
  // Two balls, each with an open port, in either order and under other names.
  const auto balls = [](const std::string& first, const std::string& second, double second_at) {
    const auto layer = [](const std::string& name, double x) {
      return "  - {name: " + name + ", inside: {sphere: {center: [" + std::to_string(x) +
             ", 0, 0], radius: 20}}, wall: w}\n";
    };
    const auto port = [](const std::string& name) {
      return "  - {name: into_" + name + ", between: [outside, " + name + "]}\n";
    };
    return compile(
        parseScene("palpate: 1\nlength: mm\nmaterials: {w: {stiffness: 500 N/m}}\nlayers:\n" +
                       layer(first, 100.0 - second_at) + layer(second, second_at) + "ports:\n" +
                       port(first) + port(second),
                   "balls.yaml"));
  };
  const ScenePtr felt = balls("one", "two", 100.0);
  const testing::TempFolder folder;
  const std::string file = folder.path("r.npy");
  {
    Session session(felt);
    RowFile rows(file, file);
    for (int n = 0; n < 400; ++n) {
      const SessionTick tick = session.step(
          {.time = n * 1e-3, .position = Vec3(0.0, 0.0, 0.03 - 1e-4 * n)}, DeviceFrame::kWorld);
      const auto entries = static_cast<std::uint32_t>(session.renderer().entries().size());
      rows.add({.tick = tick, .turn = {}, .entry_count = entries}, {});
    }
    rows.flush();
  }
  RecordNames names;
  for (const Region& region : felt->regions()) names.regions.push_back(region.name);
  for (const Port& port : felt->ports()) names.ports.push_back(port.name);
  const auto compared = [&](const ScenePtr& scene, const std::optional<RecordNames>& with) {
    RecordReader record(file);
    Session session(scene);
    return replay(record, session, DeviceFrame::kWorld, 0, {}, with);
  };
  EXPECT_EQ(compared(felt, names).different, 0U);
  // The same balls in the other order have other numbers, and the same names.
  const ScenePtr swapped = balls("two", "one", 0.0);
  EXPECT_EQ(compared(swapped, names).different, 0U);
  EXPECT_GT(compared(swapped, {}).regions, 200U);
  // Under other names they have the same numbers, and no names match.
  const ScenePtr renamed = balls("uno", "due", 100.0);
  const ReplayReport report = compared(renamed, names);
  EXPECT_GT(report.regions, 200U);
  EXPECT_EQ(report.first->what, "region, events");
  EXPECT_EQ(compared(renamed, {}).different, 0U);
}

TEST(Replay, RegionsComeIntoAndCheckpointsAreCompared) {
  const Case drawn(5);
  const testing::TempFolder folder;
  const std::string file = folder.path("r.npy");
  ASSERT_NO_FATAL_FAILURE(drawn.record(file, folder.path("r.states")));
  RecordReader record(file);
  const std::string other = folder.path("other.npy");
  {
    // The same ticks with wrong counts of entered regions.
    Session session(drawn.scene, drawn.settings);
    RowFile rows(other, other);
    TickRecord row;
    while (record.next(row)) {
      const SessionTick tick = session.step(readingOf(row), drawn.frame);
      rows.add({.tick = tick, .turn = {}, .entry_count = row.entry_count + 1U}, {});
    }
    rows.flush();
  }
  RecordReader wrong(other);
  Session again(drawn.scene, drawn.settings);
  EXPECT_EQ(replay(wrong, again, drawn.frame).first->what, "entry_count");
  SessionSettings never = drawn.settings;
  never.checkpoint_every = 0;
  Session session(drawn.scene, never);
  record.seek(0);
  const ReplayReport report = replay(record, session, drawn.frame);
  ASSERT_TRUE(report.first);
  EXPECT_EQ(report.first->tick, drawn.settings.checkpoint_every);
  EXPECT_NE(report.first->what.find("checkpoint"), std::string::npos) << report.first->what;
}

TEST(Replay, EndsBeforeAGap) {
  const Case drawn(4);
  const testing::TempFolder folder;
  const std::string file = folder.path("r.npy");
  ASSERT_NO_FATAL_FAILURE(drawn.record(file, folder.path("r.states")));
  // The record without the ticks 700 to 702.
  const std::string gapped = folder.path("gap.npy");
  {
    Session session(drawn.scene, drawn.settings);
    RecordReader record(file);
    RowFile rows(gapped, gapped);
    TickRecord row;
    while (record.next(row)) {
      const SessionTick tick = session.step(readingOf(row), drawn.frame);
      if (row.tick >= 700 && row.tick <= 702) continue;
      rows.add({.tick = tick, .turn = {}, .entry_count = row.entry_count}, {});
    }
    rows.flush();
  }
  RecordReader record(gapped);
  Session session(drawn.scene, drawn.settings);
  const ReplayReport report = replay(record, session, drawn.frame);
  EXPECT_EQ(report.gap, 700U);
  EXPECT_EQ(report.compared, 700U);
  EXPECT_EQ(report.different, 0U);
}

}  // namespace
}  // namespace palpate::devices
