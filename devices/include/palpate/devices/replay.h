#pragma once
/// A record felt anew: the same readings into a session, and what comes out held against what came out then.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "palpate/devices/record_file.h"

namespace palpate::devices {

struct ReplayReport {
  std::uint64_t ticks = 0;      ///< that the session made
  std::uint64_t compared = 0;   ///< of these
  std::uint64_t different = 0;  ///< of these: not the same bit for bit
  struct First {
    std::uint64_t tick = 0;
    double t = 0.0;    ///< [s]
    std::string what;  ///< columns of TickRecord, ", " between
  };
  std::optional<First> first;  ///< the first tick that is different
  double most_force =
      0.0;  ///< [N] largest difference of forces after their limits; infinite: one is not finite
  std::uint64_t most_force_tick = 0;
  double most_proxy = 0.0;  ///< [m] the same of proxies
  std::uint64_t most_proxy_tick = 0;
  std::uint64_t regions = 0;         ///< ticks that end in another region
  std::uint64_t contacts = 0;        ///< ticks of which one touches and the other does not
  std::optional<std::uint64_t> gap;  ///< a tick that the record has not: the replay ended before it
};

/// Feeds the record's readings to `session`, from its next row on, and compares each tick that is not below `from`. The record's next row must
/// be the tick that the session is to make: 0, or that of the state which it resumed from. Ends at the record's end, before a
/// gap, or when `stops` says so.
/// @throws Error (kInput) as RecordReader::next().
[[nodiscard]] ReplayReport replay(RecordReader& record, Session& session, DeviceFrame frame,
                                  std::uint64_t from = 0, const std::function<bool()>& stops = {});

}  // namespace palpate::devices
