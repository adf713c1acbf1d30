#include "palpate/devices/record.h"

#include <algorithm>

#include "row_format.h"

namespace palpate::devices {
namespace {

TickRecord::Vector arrayOf(const Vec3& v) noexcept { return {v.x, v.y, v.z}; }
std::uint8_t bit(bool is_set) noexcept { return is_set ? 1 : 0; }

}  // namespace

TickRecord rowOf(const RecordedTick& recorded) noexcept {
  const SessionTick& tick = recorded.tick;
  const TickResult& result = tick.result;
  TickRecord row;
  row.t = tick.reading.time;
  row.dt = tick.dt;
  row.device_position = arrayOf(tick.reading.position);
  row.device_velocity = arrayOf(tick.reading.velocity);
  row.hip = arrayOf(tick.hip.position);
  row.hip_velocity = arrayOf(tick.hip.velocity);
  row.proxy = arrayOf(result.proxy);
  row.unlimited_force = arrayOf(tick.unlimited);
  row.force = arrayOf(result.force);
  row.device_force = arrayOf(tick.force);
  row.written_force = arrayOf(recorded.turn.written);
  row.share = recorded.turn.share;
  row.tick_ns = tick.renderer_ns;
  row.tick = tick.number;
  row.buttons = tick.reading.buttons;
  row.region = result.region;
  row.event_count = result.event_count;
  row.entry_count = static_cast<std::uint8_t>(std::min<std::uint32_t>(recorded.entry_count, 255));
  std::copy_n(result.events.begin(), std::min<std::size_t>(result.event_count, row.events.size()),
              row.events.begin());
  row.contact = bit(result.contact);
  row.settled = bit(result.settled);
  row.clutch = bit(tick.is_held);
  row.checkpoint = bit(tick.is_checkpoint);
  row.stale = bit(recorded.turn.is_stale);
  row.zeroed = bit(recorded.turn.is_zeroed);
  row.shortened = bit(recorded.turn.is_shortened);
  row.late = bit(recorded.turn.is_late);
  return row;
}

DeviceState readingOf(const TickRecord& row) noexcept {
  return {.time = row.t,
          .position = vectorOf(row.device_position),
          .velocity = vectorOf(row.device_velocity),
          .buttons = row.buttons};
}

}  // namespace palpate::devices
