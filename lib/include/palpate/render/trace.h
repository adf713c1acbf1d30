#pragma once
/// Traces: one row a tick, kept in memory reserved beforehand, written as CSV afterwards.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/render/haptic_renderer.h"

namespace palpate {

struct TraceRow {
  double t = 0.0;           ///< [s]
  Vec3 hip{0.0, 0.0, 0.0};  ///< [m]
  TickResult result = {};
  std::int64_t tick_ns = 0;  ///< [ns] of the renderer's update alone
};

/// Fixed capacity, so that adding a row never allocates.
class Trace {
 public:
  explicit Trace(std::size_t capacity) { rows_.reserve(capacity); }
  /// Adds a row; beyond the capacity rows are counted as dropped, never silently.
  void add(const TraceRow& row) noexcept {
    if (rows_.size() < rows_.capacity()) {
      rows_.push_back(row);
    } else {
      ++dropped_;
    }
  }
  [[nodiscard]] std::span<const TraceRow> rows() const noexcept { return rows_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::vector<TraceRow> rows_;
  std::uint64_t dropped_ = 0;
};

/// As CSV, with the header
/// t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_ns
/// with shortest numbers that read back exactly (`nan`, `inf` for a broken sensor's position). A name
/// with a comma, quote or line end is quoted as RFC 4180 says. Names come from the scene.
[[nodiscard]] std::string traceCsv(std::span<const TraceRow> rows, const Scene& scene);

/// The same with names given: `regions` by RegionId, `ports` by PortId.
/// @throws Error (kInput) for an id that has no name.
[[nodiscard]] std::string traceCsv(std::span<const TraceRow> rows,
                                   std::span<const std::string> regions,
                                   std::span<const std::string> ports);

}  // namespace palpate
