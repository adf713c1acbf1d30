#pragma once
/// A trace for pictures: few rows, but enough that the eye misses none, however long the touch.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/devices/record.h"
#include "palpate/render/trace.h"

namespace palpate::tools {

/// Keeps all rows of a touch of up to kExact ticks. A longer one is divided into intervals of ticks
/// (all of one length, a power of 2 times kKept). Each interval keeps the first and the last row,
/// those with the largest and smallest force and coordinates of the hand, and the first few in
/// which the proxy entered another region.
class ThinTrace final : public devices::RecordSink {
 public:
  static constexpr std::size_t kKept =
      8;  ///< an interval with no more rows than this keeps them all
  static constexpr std::size_t kMostStretches = 8192;
  static constexpr std::size_t kExact = kKept * kMostStretches;

  void add(const devices::RecordedTick& tick, std::span<const RegionEntry> entries) override;
  /// The rows for all ticks so far, in order; of several regions entered in one tick only the first
  /// is kept.
  [[nodiscard]] Trace trace() const;

 private:
  struct Row {
    TraceRow row;
    std::vector<RegionEntry> entries;  ///< the first one, if there is any
  };
  using Stretch = std::vector<Row>;

  static void thin(Stretch& stretch);
  void halve();

  std::vector<Stretch> stretches_;
  std::uint64_t length_ = kKept;  ///< [ticks] in an interval
  std::uint64_t count_ = 0;       ///< ticks of the last interval
};

}  // namespace palpate::tools
