#pragma once
/// Recorder: takes what goes into each tick and what comes out, and hands it on in a thread of its own.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/session.h"

namespace palpate::devices {

/// One tick with all that it took in and all that came out.
struct RecordedTick {
  SessionTick tick;
  ServoTurn turn;
  std::uint32_t entry_count = 0;  ///< regions that the proxy came into
  bool has_state = false;         ///< RecordSink::addState() has brought what was before it
};

/// Who uses the ticks: a file, a summary, a plot. Called in the recorder's thread only, where it may allocate, wait and throw:
/// who throws gets no more of that record, the others do.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;

  /// Ticks come in order; SessionTick::number leaves a gap where some were dropped. `entries` are valid during the call.
  virtual void add(const RecordedTick& tick, std::span<const RegionEntry> entries) = 0;
  /// What was before the tick that comes next.
  virtual void addState(const SessionState&) {}
  /// Now and then, and at the end: what came so far should outlive the process.
  virtual void flush() {}

 protected:
  RecordSink() = default;
};

struct RecorderSettings {
  std::size_t ticks = 16384;  ///< room for so many that were not handed on yet: 16 s at 1 kHz, 6 MB
  std::size_t entries = 4096;
  std::size_t states = 4;
  /// When the ring is full, add() waits until there is room instead of dropping the tick: for loops that run as fast as they can.
  bool waits = false;
  double flush = 0.25;  ///< [s] at most between two flushes
  /// Called at once, in the recorder's thread, when a sink has failed.
  std::function<void(const Error&)> on_failure = {};
};

struct RecorderReport {
  std::uint64_t ticks = 0;            ///< handed on
  std::uint64_t dropped = 0;          ///< ticks for which there was no room
  std::uint64_t dropped_entries = 0;  ///< of ticks that were handed on
  std::uint64_t dropped_states = 0;
  std::vector<Error> failures = {};  ///< of sinks
};

/// Memory is fixed at construction. One thread calls add(), one finish().
class Recorder {
 public:
  /// Starts the thread. The sinks must outlive the recorder.
  /// @throws Error (kOperation) if it cannot be started.
  explicit Recorder(std::vector<RecordSink*> sinks, const RecorderSettings& settings = {});
  ~Recorder();  ///< finish()es
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Real-time safe unless RecorderSettings::waits: never allocates, locks, throws or blocks, whatever the sinks do. `state`: what
  /// was before the tick, if it is to be kept.
  void add(const SessionTick& tick, const ServoTurn& turn, std::span<const RegionEntry> entries,
           const SessionState* state = nullptr) noexcept;

  /// Hands on what is left, flushes, and ends the thread; again: the same report.
  const RecorderReport& finish();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace palpate::devices
