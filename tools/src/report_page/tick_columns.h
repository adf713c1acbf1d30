#pragma once
/// Forces, distances and energy over time, condensed so that a plot shows everything and loses no
/// peak.

#include <algorithm>
#include <vector>

#include "palpate/devices/record.h"

namespace palpate::tools {

/// The least and the most value.
struct Extent {
  double least = kInfinity;
  double most = -kInfinity;

  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  void add(const Extent& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};

/// A column: an interval of ticks.
struct TickColumn {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
  Extent force;        ///< [N] length
  Extent beyond;       ///< [m] from the proxy to the hand
  Extent work;  ///< [J] on the hand since the first tick, each force held until the next tick
};

/// All ticks in at most kMost columns of equally many ticks (except the last), in constant memory.
/// A reading without a place or a time is not counted.
class TickColumns final : public devices::RecordSink {
 public:
  static constexpr std::size_t kMost = 1024;

  void add(const devices::RecordedTick& recorded, std::span<const RegionEntry> entries) override;
  [[nodiscard]] const std::vector<TickColumn>& columns() const noexcept { return columns_; }

 private:
  std::vector<TickColumn> columns_;
  std::uint64_t length_ = 1;  ///< [ticks] of a column
  std::uint64_t count_ = 0;   ///< ticks in the last column
  double work_ = 0.0;
  bool has_last_ = false;
  Vec3 last_hip_{0.0};
  Vec3 last_force_{0.0};
};

}  // namespace palpate::tools
