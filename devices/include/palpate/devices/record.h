#pragma once
/// Records of ticks. A Recorder takes the inputs and outputs of each tick, and hands them on in a
/// thread of its own. In files, the ticks are an array that NumPy loads; beside it are the states
/// from which a replay can begin. A replay feeds the readings to a session again, and compares the
/// outputs.

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/session.h"
#include "palpate/export.h"

namespace palpate::devices {

/// One tick with all its inputs and outputs.
struct RecordedTick {
  SessionTick tick;                   ///< inputs and outputs of the session
  ServoTurn turn;                     ///< the force that the servo loop wrote for it
  std::uint32_t entry_count = 0;      ///< regions that the proxy entered
  std::uint32_t dropped_entries = 0;  ///< of these, those for which the recorder had no room
  bool has_state = false;  ///< RecordSink::addState() was called with the state before this tick
};

/// A consumer of ticks: a file, a summary, a plot. The recorder calls it in a thread of its own,
/// where it may allocate, wait and throw: a sink that throws gets no more of that record, the
/// others do.
class PALPATE_EXPORT RecordSink {
 public:
  virtual ~RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;

  /// Ticks come in order; SessionTick::number leaves a gap where some were dropped. `entries` are
  /// valid during the call.
  virtual void add(const RecordedTick& tick, std::span<const RegionEntry> entries) = 0;
  /// The state before the tick that comes next.
  virtual void addState(const SessionState&) {}
  /// Called now and then, and at the end: the data so far should survive the process.
  virtual void flush() {}

 protected:
  RecordSink() = default;
};

/// The sizes of a recorder's rings, and how it treats its sinks.
struct RecorderSettings {
  std::size_t ticks = 16384;   ///< room for ticks that were not handed on yet: 16 s at 1 kHz, 6 MB
  std::size_t entries = 4096;  ///< room for region entries of such ticks, all together
  std::size_t states = 4;      ///< room for states of such ticks
  /// When the ring is full, add() waits until there is room instead of dropping the tick: for loops
  /// that run as fast as they can.
  bool waits = false;
  double flush = 0.25;  ///< [s] the longest time between two flushes
  /// Called immediately, in the recorder's thread, when a sink has failed.
  std::function<void(const Error&)> on_failure = {};
};

/// The counts of a record that was finished.
struct RecorderReport {
  std::uint64_t ticks = 0;            ///< number handed on
  std::uint64_t dropped = 0;          ///< ticks for which there was no room
  std::uint64_t dropped_entries = 0;  ///< of ticks that were handed on
  /// States for which there was no room; their ticks were still handed on.
  std::uint64_t dropped_states = 0;
  std::vector<Error> failures = {};  ///< of sinks
};

/// Memory is fixed at construction. add() is for one thread, finish() for one, possibly another.
class PALPATE_EXPORT Recorder {
 public:
  /// Starts the thread. The sinks must outlive the recorder.
  /// @throws Error (kOperation) if it cannot be started.
  explicit Recorder(std::vector<RecordSink*> sinks, const RecorderSettings& settings = {});
  ~Recorder();  ///< finish()es
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Real-time safe unless RecorderSettings::waits: never allocates, locks, throws or blocks,
  /// whatever the sinks do. `state`: the state before the tick, if it is to be kept.
  void add(const SessionTick& tick, const ServoTurn& turn, std::span<const RegionEntry> entries,
           const SessionState* state = nullptr) noexcept;

  /// Hands on the remaining ticks, flushes, and ends the thread; calling it again returns the same
  /// report.
  const RecorderReport& finish();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// One row: the bytes of the file, little-endian and without gaps. Frames: `device` is that of the
/// readings, which DeviceInfo::frame names; `world` is the scene's.
struct TickRecord {
  /// The most ports of one tick that are stored by name; event_count counts all.
  static constexpr std::size_t kEvents = 8;
  using Vector = std::array<double, 3>;  ///< x, y, z

  double t = 0.0;                ///< [s] of the reading
  double dt = 0.0;               ///< [s] since the reading before
  Vector device_position{};      ///< [m, device] as read
  Vector device_velocity{};      ///< [m/s, device] as read; a session computes its own
  Vector hip{};                  ///< [m, world] as the renderer got it
  Vector hip_velocity{};         ///< [m/s, world] the same
  Vector proxy{};                ///< [m, world]
  Vector unlimited_force{};      ///< [N, world] before the limits of the force
  Vector force{};                ///< [N, world] after these limits
  Vector device_force{};         ///< [N, device] what the session asked for
  Vector written_force{};        ///< [N, device] what the loop wrote
  double share = 1.0;            ///< [-] of the force that the watchdog let through
  std::int64_t tick_ns = 0;      ///< [ns] of the renderer's update alone
  std::uint64_t tick = 0;        ///< from 0; a gap means that ticks were dropped
  std::uint32_t buttons = 0;     ///< one bit each
  std::uint16_t region = 0;      ///< RegionId of the proxy
  std::uint8_t event_count = 0;  ///< ports passed
  std::uint8_t entry_count = 0;  ///< regions entered; 255: that many or more
  std::array<std::uint16_t, kEvents> events{};  ///< PortId of each that was passed, in order
  std::uint8_t contact = 0;                     ///< 0 or 1, like all that follow
  std::uint8_t settled = 0;                     ///< TickResult::settled
  std::uint8_t clutch = 0;                      ///< the clutch is held
  std::uint8_t checkpoint = 0;  ///< the session's checkpoint was taken before this tick
  std::uint8_t stale = 0;       ///< the previous reading was used again
  std::uint8_t zeroed = 0;      ///< the force was not finite, or answered a reading that was not
  std::uint8_t shortened = 0;   ///< the force was shortened to the device's maximum
  std::uint8_t late = 0;        ///< this tick ended after the next one was due
};
static_assert(std::is_trivially_copyable_v<TickRecord>);
static_assert(sizeof(TickRecord) == 288, "the file has no gaps between the columns");

/// Converts a tick to a row. Ports beyond the first kEvents are left out, and more than 255 region
/// entries count as 255.
[[nodiscard]] PALPATE_EXPORT TickRecord rowOf(const RecordedTick& recorded) noexcept;

/// The device's reading at that tick.
[[nodiscard]] PALPATE_EXPORT DeviceState readingOf(const TickRecord& row) noexcept;

/// A file that is written from front to back, except that a part at the front can be overwritten.
class PALPATE_EXPORT OutFile {
 public:
  /// Opens `file`, which is emptied; `name` is for messages. @throws Error (kOperation,
  /// record.write).
  OutFile(const std::string& file, std::string name);
  ~OutFile();
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  /// Appends at the end. If the disk has no room for all of it, as many whole pieces of `piece`
  /// bytes stay as there is room for. @throws Error (kOperation, record.write) with the system's
  /// reason, for example a full disk.
  void append(const void* bytes, std::size_t count, std::size_t piece);
  void overwrite(std::uint64_t at, std::string_view bytes);  ///< @throws Error as append()
  /// [bytes] Length of the file.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

 private:
  [[nodiscard]] Error failure() const;  ///< of the last system call

  std::string name_;
  int number_ = -1;
  std::uint64_t size_ = 0;
};

/// Ticks as a structured array (.npy, format 1.0), whose columns are those of TickRecord. Rows are
/// written a megabyte at a time or at flush(), and the number of rows only after them: so all rows
/// that the header promises are in the file, even if the process is killed.
class PALPATE_EXPORT RowFile final : public RecordSink {
 public:
  /// @throws Error as OutFile.
  RowFile(const std::string& file, std::string name);
  void add(const RecordedTick& tick, std::span<const RegionEntry> entries) override;
  void flush() override;

 private:
  OutFile out_;
  std::vector<TickRecord> rows_;  ///< rows that are not written yet
};

/// States of a session, for the build that wrote them.
class PALPATE_EXPORT StateFile final : public RecordSink {
 public:
  /// `about` describes what the record was made with; the states can be used only with a record
  /// that has the same description. @throws Error as OutFile.
  StateFile(const std::string& file, std::string name, std::string_view about);
  void add(const RecordedTick&, std::span<const RegionEntry>) override {}
  void addState(const SessionState& state) override;

 private:
  OutFile out_;
};

/// Reads what RowFile wrote, front to back, in constant memory.
class PALPATE_EXPORT RecordReader {
 public:
  /// @throws Error (kInput): record.unreadable, record.magic (not a .npy file), record.columns (not
  /// those of a record).
  explicit RecordReader(std::string file);

  /// Number of rows that are completely in the file.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Number of rows that the header promises; more than size() if the file was truncated.
  [[nodiscard]] std::uint64_t promised() const noexcept { return promised_; }
  /// Moves to the first row whose number is not below `tick`: next() then reads that row.
  void seek(std::uint64_t tick);
  /// Reads the next row; false at the end. @throws Error (kInput, record.unreadable).
  [[nodiscard]] bool next(TickRecord& row);

 private:
  /// @throws Error (kInput, record.unreadable).
  void read(std::uint64_t at, TickRecord& row);

  std::string file_;
  std::ifstream in_;
  std::uint64_t in_at_ = 0;  ///< the row at whose beginning `in_` is
  std::uint64_t size_ = 0;
  std::uint64_t promised_ = 0;
  std::uint64_t at_ = 0;  ///< the next row
};

/// Reads what StateFile wrote.
class PALPATE_EXPORT StateReader {
 public:
  /// @throws Error (kInput): record.unreadable; record.states for a file that does not hold states,
  /// or holds those of another build or another record.
  StateReader(std::string file, std::string_view about);

  /// Number of states in the file, damaged ones included.
  [[nodiscard]] std::size_t size() const noexcept { return ticks_.size(); }
  /// The ticks before which there is a state, in order.
  [[nodiscard]] const std::vector<std::uint64_t>& ticks() const noexcept { return ticks_; }
  /// The latest undamaged state that is not later than `tick`; no value if there is none.
  [[nodiscard]] std::optional<SessionState> before(std::uint64_t tick);

 private:
  std::string file_;
  std::ifstream in_;
  std::vector<std::uint64_t> ticks_;
};

/// A text with everything that states depend on: the version, the compiler, the size and the
/// layout. Builds with different texts refuse each other's states.
[[nodiscard]] PALPATE_EXPORT std::string stateBuild();

/// A 64-bit FNV-1a checksum: it detects damage, but not deliberate changes.
[[nodiscard]] PALPATE_EXPORT std::uint64_t checksum(
    std::string_view bytes, std::uint64_t begin = 0xcbf29ce484222325U) noexcept;

/// The differences between a record and its replay.
struct ReplayReport {
  std::uint64_t ticks = 0;      ///< ticks that the session made
  std::uint64_t compared = 0;   ///< of these, ticks that were compared
  std::uint64_t different = 0;  ///< of these, those that are not the same bit for bit
  /// A tick that differs.
  struct First {
    std::uint64_t tick = 0;  ///< TickRecord::tick
    double t = 0.0;          ///< [s]
    std::string what;        ///< columns of TickRecord, separated by ", "
  };
  std::optional<First> first;  ///< the first tick that is different
  /// [N] largest difference between forces after their limits; infinite if one is not finite
  double most_force = 0.0;
  std::uint64_t most_force_tick = 0;  ///< the tick of that difference; 0 if no force differs
  double most_proxy = 0.0;            ///< [m] largest difference between proxies
  std::uint64_t most_proxy_tick = 0;  ///< the tick of that difference; 0 if no proxy differs
  std::uint64_t regions = 0;          ///< ticks that end in different regions
  std::uint64_t contacts = 0;         ///< ticks in which only one of the two touches
  std::optional<std::uint64_t> gap;  ///< a tick missing from the record: the replay ended before it
};

/// The names of the regions and ports of a record, by their numbers in it.
struct RecordNames {
  std::vector<std::string> regions;  ///< indexed by TickRecord::region
  std::vector<std::string> ports;    ///< indexed by the numbers in TickRecord::events
};

/// Feeds the record's readings to `session`, from its next row on, and compares each tick whose
/// number is not below `from`. The record's next row must be the tick that the session makes next:
/// 0, or that of the state from which it resumed. Ends at the record's end, before a gap, or when
/// `stops` returns true. With `names`, a region or port of the record is matched with the one of
/// the same name in the session's scene, whatever its number; one that has no match there counts as
/// different. Without `names`, numbers are compared. @throws Error (kInput) as
/// RecordReader::next().
[[nodiscard]] PALPATE_EXPORT ReplayReport replay(RecordReader& record, Session& session,
                                                 DeviceFrame frame, std::uint64_t from = 0,
                                                 const std::function<bool()>& stops = {},
                                                 const std::optional<RecordNames>& names = {});

}  // namespace palpate::devices
