#pragma once
/// Records in files: the ticks as an array that NumPy loads, and beside it the states from which a replay can begin.

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/devices/record.h"

namespace palpate::devices {

/// A file that is written from front to back, and of which something at the front is written anew.
class OutFile {
 public:
  /// Opens `file`, which is emptied; `name`: for messages. @throws Error (kOperation, record.write).
  OutFile(const std::string& file, std::string name);
  ~OutFile();
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  /// At the end. Where not all of it can be written, as many whole pieces of `piece` bytes stay as there is room for.
  /// @throws Error (kOperation, record.write) with what the system says: a full disk, for one.
  void append(const void* bytes, std::size_t count, std::size_t piece);
  void overwrite(std::uint64_t at, std::string_view bytes);  ///< @throws Error as append()
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

 private:
  [[nodiscard]] Error failure() const;  ///< of the last system call

  std::string name_;
  int number_ = -1;
  std::uint64_t size_ = 0;
};

/// Ticks as a structured array (.npy, format 1.0), whose columns are those of TickRecord. Rows are written a megabyte at a time or at
/// flush(), and the number of rows after them: whatever ends the process, what the header promises is there, whole.
class RowFile final : public RecordSink {
 public:
  /// @throws Error as OutFile.
  RowFile(const std::string& file, std::string name);
  void add(const RecordedTick& tick, std::span<const RegionEntry> entries) override;
  void flush() override;

 private:
  OutFile out_;
  std::vector<TickRecord> rows_;  ///< that were not written yet
};

/// States of a session, for the build that wrote them.
class StateFile final : public RecordSink {
 public:
  /// `about`: what the record was made with; only a record about which the same is known has these states.
  /// @throws Error as OutFile.
  StateFile(const std::string& file, std::string name, std::string_view about);
  void add(const RecordedTick&, std::span<const RegionEntry>) override {}
  void addState(const SessionState& state) override;

 private:
  OutFile out_;
};

/// Reads what RowFile wrote, front to back, in constant memory.
class RecordReader {
 public:
  /// @throws Error (kInput): record.unreadable, record.magic (not a .npy file), record.columns (not those of a record).
  explicit RecordReader(std::string file);

  /// Rows that are there, whole.
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  /// Rows that the header promises; more than size(): the file was cut.
  [[nodiscard]] std::uint64_t promised() const noexcept { return promised_; }
  /// The next row is the first whose number is not below `tick`.
  void seek(std::uint64_t tick);
  /// The next row; false at the end. @throws Error (kInput, record.unreadable).
  [[nodiscard]] bool next(TickRecord& row);

 private:
  /// @throws Error (kInput, record.unreadable).
  void read(std::uint64_t at, TickRecord& row);

  std::string file_;
  std::ifstream in_;
  std::uint64_t in_at_ = 0;  ///< the row that `in_` stands before
  std::uint64_t size_ = 0;
  std::uint64_t promised_ = 0;
  std::uint64_t at_ = 0;  ///< the next row
};

/// Reads what StateFile wrote.
class StateReader {
 public:
  /// @throws Error (kInput): record.unreadable; record.states for a file that does not hold states, or holds those of another build or another
  /// record.
  StateReader(std::string file, std::string_view about);

  [[nodiscard]] std::size_t size() const noexcept { return ticks_.size(); }
  /// The ticks before which there is a state, in order.
  [[nodiscard]] const std::vector<std::uint64_t>& ticks() const noexcept { return ticks_; }
  /// The latest state that is whole and no later than `tick`; empty if there is none.
  [[nodiscard]] std::optional<SessionState> before(std::uint64_t tick);

 private:
  std::string file_;
  std::ifstream in_;
  std::vector<std::uint64_t> ticks_;
};

/// What states depend on: the version, the compiler, the size and the layout. States of one are refused by another.
[[nodiscard]] std::string stateBuild();

/// A checksum, FNV-1a of 64 bits: against damage, not against deceit.
[[nodiscard]] std::uint64_t checksum(std::string_view bytes,
                                     std::uint64_t begin = 0xcbf29ce484222325U) noexcept;

}  // namespace palpate::devices
