#pragma once
/// Traces: one row a tick, kept in memory reserved beforehand, written as CSV afterwards.

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/export.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

/// One tick of a trace.
struct TraceRow {
  double t = 0.0;               ///< [s]
  Vec3 hip{0.0, 0.0, 0.0};      ///< [m]
  TickResult result = {};       ///< force, proxy, region and events of the tick
  std::int64_t tick_ns = 0;     ///< [ns] time of the renderer's update alone
  std::size_t first_entry = 0;  ///< index in Trace::entries() of this tick's first entry
  std::size_t entry_count = 0;  ///< number of its entries that were kept
};

/// Fixed capacity, so that adding a row never allocates.
class Trace {
 public:
  /// Room for entered regions: one a row, and kMoreEntries more.
  static constexpr std::size_t kMoreEntries = 1024;

  /// Reserves memory for `capacity` rows.
  explicit Trace(std::size_t capacity) {
    rows_.reserve(capacity);
    entries_.reserve(capacity + kMoreEntries);
  }
  /// Adds a row and the regions entered in its tick. Rows and entries that no longer fit are
  /// counted as dropped.
  void add(TraceRow row, std::span<const RegionEntry> entries = {}) noexcept {
    if (rows_.size() == rows_.capacity()) {
      ++dropped_;
      return;
    }
    row.first_entry = entries_.size();
    row.entry_count = std::min(entries.size(), entries_.capacity() - entries_.size());
    dropped_entries_ += entries.size() - row.entry_count;
    const std::span<const RegionEntry> kept = entries.first(row.entry_count);
    entries_.insert(entries_.end(), kept.begin(), kept.end());
    rows_.push_back(row);
  }
  /// The rows that were kept, in the order in which they were added.
  [[nodiscard]] std::span<const TraceRow> rows() const noexcept { return rows_; }
  /// HapticRenderer::entries() of all rows, in order.
  [[nodiscard]] std::span<const RegionEntry> entries() const noexcept { return entries_; }
  /// The entries of one row, which must be an element of rows().
  [[nodiscard]] std::span<const RegionEntry> entriesOf(const TraceRow& row) const noexcept {
    return std::span<const RegionEntry>(entries_).subspan(row.first_entry, row.entry_count);
  }
  /// Number of rows for which there was no room.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }
  /// Number of region entries for which there was no room; those of dropped rows do not
  /// count.
  [[nodiscard]] std::uint64_t droppedEntries() const noexcept { return dropped_entries_; }

 private:
  std::vector<TraceRow> rows_;
  std::vector<RegionEntry> entries_;
  std::uint64_t dropped_ = 0;
  std::uint64_t dropped_entries_ = 0;
};

/// Trace rows as CSV, one at a time: header() followed by add() for each row gives the same text as
/// traceCsv(). Names come from the scene.
class PALPATE_EXPORT TraceText {
 public:
  /// Copies the names of the regions and ports of `scene`.
  explicit TraceText(const Scene& scene);
  /// Names of regions, indexed by RegionId, and of ports, indexed by PortId.
  TraceText(std::span<const std::string> regions, std::span<const std::string> ports);

  /// The first line, with the names of the columns and a line end.
  [[nodiscard]] static std::string_view header() noexcept;
  /// Appends the row to `text`. @throws Error (kInput) for an id that has no name.
  void add(std::string& text, const TraceRow& row) const;

 private:
  std::vector<std::string> regions_;  ///< quoted where that is needed
  std::vector<std::string> ports_;
};

/// As CSV, with the header
/// t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_ns
/// Numbers are the shortest that read back exactly (`nan`, `inf` for a broken sensor's position). A
/// name with a comma, quote or line end is quoted as RFC 4180 says. Names come from the scene.
[[nodiscard]] PALPATE_EXPORT std::string traceCsv(std::span<const TraceRow> rows,
                                                  const Scene& scene);

/// The same with the names given: `regions` indexed by RegionId, `ports` indexed by PortId.
/// @throws Error (kInput) for an id that has no name.
[[nodiscard]] PALPATE_EXPORT std::string traceCsv(std::span<const TraceRow> rows,
                                                  std::span<const std::string> regions,
                                                  std::span<const std::string> ports);

}  // namespace palpate
