// Everything that goes into the recorder comes out of it, in order and without making the loop
// wait, whatever its sinks do.

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "palpate/devices/record.h"
#include "support/alloc_guard.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

/// A tick whose contents all derive from its number, so that it can be identified.
SessionTick tickOf(std::uint64_t number) {
  SessionTick tick;
  tick.number = number;
  tick.reading.time = 1e-3 * static_cast<double>(number);
  tick.force = Vec3(static_cast<double>(number), 1.0, 2.0);
  return tick;
}

class Collector : public RecordSink {
 public:
  void add(const RecordedTick& tick, std::span<const RegionEntry> entries) override {
    ASSERT_TRUE(testing::waitUntil([&] { return !blocks; }));
    ASSERT_EQ(tick.tick.force.x, static_cast<double>(tick.tick.number));
    ASSERT_EQ(entries.size(), tick.entry_count - tick.dropped_entries);
    for (const RegionEntry& entry : entries) {
      ASSERT_EQ(entry.force, static_cast<double>(tick.tick.number));
    }
    entry_count += entries.size();
    if (tick.has_state) {
      ASSERT_EQ(states.back(), tick.tick.number);
    }
    numbers.push_back(tick.tick.number);
  }
  void addState(const SessionState& state) override { states.push_back(state.ticks); }
  void flush() override { flushed = numbers.size(); }

  std::atomic<bool> blocks{false};
  std::vector<std::uint64_t> numbers;
  std::vector<std::uint64_t> states;
  std::size_t entry_count = 0;
  std::size_t flushed = 0;
};

class Thrower final : public RecordSink {
 public:
  explicit Thrower(std::size_t good) : left(good) {}
  void add(const RecordedTick&, std::span<const RegionEntry>) override {
    if (left-- == 0) throw std::runtime_error("enough");
    ++taken;
  }
  std::size_t left;
  std::size_t taken = 0;
};

TEST(Recorder, AllTicksComeOutInOrderOfALoopThatMayWait) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Collector all;
    Thrower thrower(random() % 300);
    const std::size_t good = thrower.left;
    std::atomic<int> told = 0;
    Recorder recorder({&all, &thrower}, {.ticks = 1 + random() % 64,
                                         .entries = 1 + random() % 8,
                                         .states = 1,
                                         .waits = true,
                                         .flush = random() % 2 == 0 ? 0.0 : 1.0,
                                         .on_failure = [&](const Error&) { ++told; }});
    const std::size_t count = 500 + random() % 3000;
    std::size_t states = 0;
    auto state = std::make_unique<SessionState>();
    for (std::uint64_t n = 0; n < count; ++n) {
      std::vector<RegionEntry> entries(random() % 20 == 0 ? random() % 2 : 0);
      for (RegionEntry& entry : entries) entry.force = static_cast<double>(n);
      const bool has_state = random() % 97 == 0;
      states += has_state ? 1 : 0;
      state->ticks = n;
      recorder.add(tickOf(n), {}, entries, has_state ? state.get() : nullptr);
    }
    const RecorderReport& report = recorder.finish();
    EXPECT_EQ(report.ticks, count);
    EXPECT_EQ(report.dropped + report.dropped_entries + report.dropped_states, 0U);
    ASSERT_EQ(all.numbers.size(), count) << seed;
    for (std::uint64_t n = 0; n < count; ++n) ASSERT_EQ(all.numbers[n], n);
    EXPECT_EQ(all.states.size(), states);
    EXPECT_EQ(all.flushed, count) << "what came is flushed at the end";
    // The sink that threw got no more ticks, and the report names its error.
    EXPECT_EQ(thrower.taken, good);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_EQ(told, 1);
    EXPECT_NE(report.failures[0].problem().message.find("enough"), std::string::npos);
  }
}

TEST(Recorder, ARealTimeLoopNeverWaitsAndWhatIsDroppedIsCounted) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    Collector all;
    all.blocks = true;  // like a disk that does not answer
    const std::size_t room = std::size_t{1} << (1 + random() % 6);
    Recorder recorder({&all}, {.ticks = room, .entries = 4, .states = 2});
    const std::uint64_t count = room + 1 + random() % 200;
    const RegionEntry none{};
    const auto state = std::make_unique<SessionState>();
    {
      const testing::AllocGuard guard;
      for (std::uint64_t n = 0; n < count; ++n) {
        SessionTick tick = tickOf(n);
        RegionEntry entry = none;
        entry.force = static_cast<double>(n);
        state->ticks = n;
        recorder.add(tick, {}, {&entry, 1}, state.get());
      }
      EXPECT_EQ(guard.violations(), 0);
    }
    all.blocks = false;
    const RecorderReport& report = recorder.finish();
    EXPECT_EQ(report.ticks, room) << "the first, as many as there was room for";
    EXPECT_EQ(report.ticks + report.dropped, count);
    ASSERT_EQ(all.numbers.size(), room);
    for (std::uint64_t n = 0; n < room; ++n) ASSERT_EQ(all.numbers[n], n);
    EXPECT_EQ(all.entry_count + report.dropped_entries, room);
    EXPECT_EQ(all.states.size() + report.dropped_states, room);
    EXPECT_EQ(all.states.size(), std::min<std::size_t>(room, 2));
  }
}

TEST(Recorder, ATickWithMoreEntriesThanThereIsRoomForLosesSomeAndEndsNoLoop) {
  Collector all;
  Recorder recorder({&all}, {.ticks = 4, .entries = 4, .waits = true});
  std::vector<RegionEntry> many(10);
  for (std::uint64_t n = 0; n < 50; ++n) {
    for (RegionEntry& entry : many) entry.force = static_cast<double>(n);
    recorder.add(tickOf(n), {}, many);
  }
  const RecorderReport& report = recorder.finish();
  EXPECT_EQ(report.ticks, 50U);
  EXPECT_EQ(report.dropped_entries, 50U * 6U);
}

}  // namespace
}  // namespace palpate::devices
