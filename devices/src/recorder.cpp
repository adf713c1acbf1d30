#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>

#include "palpate/devices/record.h"
#include "spsc_ring.h"

namespace palpate::devices {
namespace {

using Clock = std::chrono::steady_clock;

// The sleep of a thread that finds nothing to do: short compared with the time that a full ring
// covers.
constexpr std::chrono::milliseconds kWriterNap{1};
constexpr std::chrono::microseconds kWaiterNap{100};

}  // namespace

class Recorder::Work {
 public:
  Work(std::vector<RecordSink*> sinks, const RecorderSettings& settings)
      : settings_(settings),
        sinks_(std::move(sinks)),
        ticks_(settings.ticks),
        entries_(settings.entries),
        states_(settings.states) {
    taken_entries_.reserve(settings.entries);
    try {
      thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& error) {
      throw Error(
          ErrorKind::kOperation,
          {"record.thread", std::string("the recorder's thread cannot be started: ") + error.what(),
           "close other programs, or raise the limit on processes (ulimit -u)"});
    }
  }

  void add(const SessionTick& tick, const ServoTurn& turn, std::span<const RegionEntry> entries,
           const SessionState* state) noexcept {
    const auto wait = [this](const auto& ring, std::size_t count) {
      while (settings_.waits && ring.room() < count) std::this_thread::sleep_for(kWaiterNap);
    };
    wait(ticks_, 1);
    if (ticks_.room() == 0) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    RecordedTick made{
        .tick = tick, .turn = turn, .entry_count = static_cast<std::uint32_t>(entries.size())};
    wait(entries_, std::min(entries.size(), entries_.capacity()));
    for (const RegionEntry& entry : entries) {
      if (entries_.room() == 0) {
        dropped_entries_.fetch_add(1, std::memory_order_relaxed);
        ++made.dropped_entries;
        continue;
      }
      entries_.put(entry);
    }
    if (state != nullptr) {
      wait(states_, 1);
      made.has_state = states_.room() > 0;
      if (made.has_state) {
        states_.put(*state);
      } else {
        dropped_states_.fetch_add(1, std::memory_order_relaxed);
      }
    }
    ticks_.put(made);  // last, so that everything that belongs to it is there already
  }

  const RecorderReport& finish() {
    if (thread_.joinable()) {
      is_closing_.store(true, std::memory_order_release);
      thread_.join();
      report_.dropped = dropped_.load();
      report_.dropped_entries = dropped_entries_.load();
      report_.dropped_states = dropped_states_.load();
    }
    return report_;
  }

 private:
  void run() {
    Clock::time_point flushed = Clock::now();
    bool is_clean = true;
    while (true) {
      const bool is_closing = is_closing_.load(std::memory_order_acquire);
      std::size_t count = ticks_.count();
      const bool is_idle = count == 0;
      for (; count > 0; --count) handOn();
      is_clean = is_clean && is_idle;
      if (is_idle && is_closing) break;
      if (!is_clean &&
          std::chrono::duration<double>(Clock::now() - flushed).count() >= settings_.flush) {
        each([](RecordSink& sink) { sink.flush(); });
        flushed = Clock::now();
        is_clean = true;
      }
      if (is_idle) std::this_thread::sleep_for(kWriterNap);
    }
    each([](RecordSink& sink) { sink.flush(); });
  }

  void handOn() {
    const RecordedTick tick = ticks_.front();
    taken_entries_.clear();
    for (std::uint32_t i = 0; i < tick.entry_count - tick.dropped_entries; ++i) {
      taken_entries_.push_back(entries_.front());
      entries_.pop();
    }
    if (tick.has_state) {
      each([&](RecordSink& sink) { sink.addState(states_.front()); });
      states_.pop();
    }
    each([&](RecordSink& sink) { sink.add(tick, taken_entries_); });
    ++report_.ticks;
    ticks_.pop();
  }

  template <typename Call>
  void each(const Call& call) {
    for (RecordSink*& sink : sinks_) {
      if (sink == nullptr) continue;
      try {
        call(*sink);
      } catch (const Error& error) {
        sink = nullptr;
        tellFailure(error);
      } catch (const std::exception& error) {
        sink = nullptr;
        tellFailure(
            {ErrorKind::kOperation,
             {"record.failed", std::string("a part of the record failed: ") + error.what()}});
      }
    }
  }

  void tellFailure(const Error& error) {
    report_.failures.push_back(error);
    if (settings_.on_failure) settings_.on_failure(error);
  }

  RecorderSettings settings_;
  std::vector<RecordSink*> sinks_;  ///< null: the sink has failed
  SpscRing<RecordedTick> ticks_;
  SpscRing<RegionEntry> entries_;
  SpscRing<SessionState> states_;
  std::vector<RegionEntry> taken_entries_;  ///< of the tick that is being handed on
  std::atomic<bool> is_closing_{false};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<std::uint64_t> dropped_entries_{0};
  std::atomic<std::uint64_t> dropped_states_{0};
  RecorderReport report_;
  std::thread thread_;
};

Recorder::Recorder(std::vector<RecordSink*> sinks, const RecorderSettings& settings)
    : work_(std::make_unique<Work>(std::move(sinks), settings)) {}

Recorder::~Recorder() { (void)work_->finish(); }

void Recorder::add(const SessionTick& tick, const ServoTurn& turn,
                   std::span<const RegionEntry> entries, const SessionState* state) noexcept {
  work_->add(tick, turn, entries, state);
}

const RecorderReport& Recorder::finish() { return work_->finish(); }

}  // namespace palpate::devices
