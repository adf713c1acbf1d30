#pragma once
/// The ticks of a trace or a record, with the names of their regions and ports.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/devices/record.h"
#include "record_about.h"

namespace palpate::tools {

struct TickSource {
  std::vector<std::string> regions;  ///< names by RegionId
  std::vector<std::string> ports;    ///< names by PortId
  std::uint64_t ticks = 0;
  std::optional<RecordAbout> about;  ///< only for a record
  /// Number of ticks by a record's header; if it is more than `ticks`, the record was cut short
  std::uint64_t promised = 0;
};

/// From a `touch --trace`: ids are given in the order in which names appear.
/// @throws Error (kInput, trace.*; kCancelled).
[[nodiscard]] TickSource readTrace(const std::string& file,
                                   std::span<devices::RecordSink* const> sinks);
/// From a `touch --record`. @throws Error (kInput, record.*; kCancelled).
[[nodiscard]] TickSource readRecord(const std::string& file, const RecordAbout& about,
                                    std::span<devices::RecordSink* const> sinks);

}  // namespace palpate::tools
