#pragma once
/// A trace for pictures: so many rows that the eye finds none missing, however long the touch.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/devices/record.h"
#include "palpate/render/trace.h"

namespace palpate::tools {

/// All rows of a touch of up to kExact ticks. Of a longer one, of each stretch of ticks (all of one
/// length, a power of 2 times kKept): the first and the last row, those with the largest and
/// smallest force and coordinates of the hand, and the first few in which the proxy came into
/// another region.
class ThinTrace final : public devices::RecordSink {
 public:
  static constexpr std::size_t kKept =
      8;  ///< rows of a stretch that are kept in any case, if it has no more
  static constexpr std::size_t kMostStretches = 8192;
  static constexpr std::size_t kExact = kKept * kMostStretches;

  void add(const devices::RecordedTick& tick, std::span<const RegionEntry> entries) override;
  /// Of all ticks so far, in order; of the regions entered in a tick the first alone.
  [[nodiscard]] Trace trace() const;

 private:
  struct Row {
    TraceRow row;
    std::vector<RegionEntry> entries;  ///< the first, if there is any
  };
  using Stretch = std::vector<Row>;

  static void thin(Stretch& stretch);
  void halve();

  std::vector<Stretch> stretches_;
  std::uint64_t length_ = kKept;  ///< [ticks] of a stretch
  std::uint64_t count_ = 0;       ///< ticks of the last stretch
};

}  // namespace palpate::tools
