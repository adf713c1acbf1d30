#include "report_page/tick_source.h"

#include <algorithm>
#include <limits>
#include <map>

#include "console.h"
#include "palpate/core/error.h"
#include "text.h"
#include "trace_reader.h"

namespace palpate::tools {
namespace {

constexpr std::uint64_t kBetweenLooks = 4096;  // ticks between two checks for a stop
/// Ids have 16 bits.
constexpr std::size_t kMostNames = std::numeric_limits<std::uint16_t>::max();

/// Gives names ids in the order in which they appear.
class Names {
 public:
  Names(std::vector<std::string>& names, const std::string& file) : names_(&names), file_(&file) {}

  [[nodiscard]] std::uint16_t idOf(const std::string& name) {
    const auto [at, is_new] = ids_.try_emplace(name, static_cast<std::uint16_t>(ids_.size()));
    if (is_new) {
      if (names_->size() == kMostNames) {
        throw inputError("trace.names", "the trace has more than 65 535 names",
                         "no scene has so many: is the file damaged?", *file_);
      }
      names_->push_back(name);
    }
    return at->second;
  }

 private:
  std::map<std::string, std::uint16_t> ids_;
  std::vector<std::string>* names_;
  const std::string* file_;
};

void give(const devices::RecordedTick& tick, std::span<devices::RecordSink* const> sinks,
          TickSource& source) {
  for (devices::RecordSink* sink : sinks) sink->add(tick, {});
  if (++source.ticks % kBetweenLooks == 0) checkStop();
}

Vec3 vectorOf(const devices::TickRecord::Vector& v) { return {v[0], v[1], v[2]}; }

}  // namespace

TickSource readTrace(const std::string& file, std::span<devices::RecordSink* const> sinks) {
  TraceReader reader(file);
  TickSource source;
  Names regions(source.regions, file);
  Names ports(source.ports, file);
  TraceLine row;
  while (reader.next(row)) {
    devices::RecordedTick tick;
    TickResult& result = tick.tick.result;
    tick.tick.number = source.ticks;
    tick.tick.reading.time = row.t;
    tick.tick.hip.position = row.is_finite ? row.hip : Vec3(kInfinity);
    tick.tick.renderer_ns = row.tick_ns;
    result.proxy = row.proxy;
    result.force = row.force;
    result.region = regions.idOf(row.region);
    result.contact = row.contact;
    if (!row.ports.empty()) {
      for (const std::string_view port : split(row.ports, ';')) {
        if (result.event_count == TickResult::kMaxEvents) break;
        result.events[result.event_count++] = ports.idOf(std::string(port));
      }
    }
    give(tick, sinks, source);
  }
  if (source.ticks == 0) throw inputError("trace.empty", "the trace has no rows", "", file);
  source.promised = source.ticks;
  return source;
}

TickSource readRecord(const std::string& file, const RecordAbout& about,
                      std::span<devices::RecordSink* const> sinks) {
  devices::RecordReader reader(file);
  TickSource source;
  source.regions = about.regions;
  source.ports = about.ports;
  source.about = about;
  source.promised = reader.promised();
  devices::TickRecord row;
  while (reader.next(row)) {
    devices::RecordedTick tick;
    TickResult& result = tick.tick.result;
    tick.tick.number = row.tick;
    tick.tick.reading.time = row.t;
    tick.tick.hip.position = vectorOf(row.hip);
    tick.tick.renderer_ns = row.tick_ns;
    result.proxy = vectorOf(row.proxy);
    result.force = vectorOf(row.force);
    result.region = row.region;
    result.contact = row.contact != 0;
    result.settled = row.settled != 0;
    result.event_count = static_cast<std::uint8_t>(
        std::min<std::size_t>(row.event_count, devices::TickRecord::kEvents));
    for (std::size_t i = 0; i < result.event_count; ++i) result.events[i] = row.events[i];
    const bool has_names =
        result.region < source.regions.size() &&
        std::all_of(result.events.begin(), result.events.begin() + result.event_count,
                    [&](PortId port) { return port < source.ports.size(); });
    if (!has_names) {
      throw inputError("record.about",
                       "tick " + std::to_string(row.tick) +
                           " is in a region, or passed a port, "
                           "that FILE.npy.json does not list",
                       "a record and its FILE.npy.json go together", aboutFile(file));
    }
    give(tick, sinks, source);
  }
  if (source.ticks == 0) {
    throw inputError("record.empty", "there is no tick in the record", {}, file);
  }
  return source;
}

}  // namespace palpate::tools
