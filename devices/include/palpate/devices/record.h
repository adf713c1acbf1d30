#pragma once
/// TickRecord: a tick as it stands in a record's file, for NumPy and for replay().

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "palpate/devices/recorder.h"

namespace palpate::devices {

/// One row: the bytes of the file, little-endian and without gaps. Frames: `device`: of the readings, which DeviceInfo::frame
/// says; `world`: the scene's.
struct TickRecord {
  /// Ports of one tick that have room by name; event_count counts on.
  static constexpr std::size_t kEvents = 8;
  using Vector = std::array<double, 3>;

  double t = 0.0;                               ///< [s] of the reading
  double dt = 0.0;                              ///< [s] since the reading before
  Vector device_position{};                     ///< [m, device] as read
  Vector device_velocity{};                     ///< [m/s, device] as read; a session makes its own
  Vector hip{};                                 ///< [m, world] as the renderer got it
  Vector hip_velocity{};                        ///< [m/s, world] the same
  Vector proxy{};                               ///< [m, world]
  Vector unlimited_force{};                     ///< [N, world] before the limits of the force
  Vector force{};                               ///< [N, world] after them
  Vector device_force{};                        ///< [N, device] what the session asked for
  Vector written_force{};                       ///< [N, device] what the loop wrote
  double share = 1.0;                           ///< [-] of the force that the watchdog let through
  std::int64_t tick_ns = 0;                     ///< [ns] of the renderer's update alone
  std::uint64_t tick = 0;                       ///< from 0; a gap is where ticks were dropped
  std::uint32_t buttons = 0;                    ///< a bit each
  std::uint16_t region = 0;                     ///< RegionId of the proxy
  std::uint8_t event_count = 0;                 ///< ports passed
  std::uint8_t entry_count = 0;                 ///< regions come into; 255: so many or more
  std::array<std::uint16_t, kEvents> events{};  ///< PortId of each that was passed, in order
  std::uint8_t contact = 0;                     ///< 0 or 1, as all that follow
  std::uint8_t settled = 0;
  std::uint8_t clutch = 0;      ///< is held
  std::uint8_t checkpoint = 0;  ///< the session's checkpoint was taken before this tick
  std::uint8_t stale = 0;       ///< the reading before, once more
  std::uint8_t zeroed = 0;      ///< the force was not finite, or answered what was not
  std::uint8_t shortened = 0;   ///< to the device's maximum
  std::uint8_t late = 0;        ///< ended after the next tick was due
};
static_assert(std::is_trivially_copyable_v<TickRecord>);
static_assert(sizeof(TickRecord) == 288, "the file has no gaps between the columns");

[[nodiscard]] TickRecord rowOf(const RecordedTick& recorded) noexcept;

/// What the device said at that tick.
[[nodiscard]] DeviceState readingOf(const TickRecord& row) noexcept;

}  // namespace palpate::devices
