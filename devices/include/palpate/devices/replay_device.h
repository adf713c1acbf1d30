#pragma once
/// A device that repeats the readings of a record, and fails where a test requests it.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// A fault that ReplayDevice simulates.
enum class InjectedKind : std::uint8_t {
  kStale,        ///< no new reading; the hand's next row comes later
  kShortPacket,  ///< a truncated reply: its row is lost, and the driver answers kStale
  kTimeout,      ///< read() answers DeviceStatus::kTimeout, and the row is lost
  kUnplug,       ///< disconnected until it is opened again
  kNan,          ///< a position that is not a number
  kJump,         ///< a position that is off by half a meter
};

/// A row of calls of ReplayDevice::read() that go wrong.
struct InjectedFault {
  std::uint64_t read = 0;  ///< index, from 0, of the call of read() at which it begins
  InjectedKind kind = InjectedKind::kStale;  ///< how these calls go wrong
  std::uint64_t count = 1;                   ///< number of calls
};

/// Each read() returns one row of the record, with its time, velocity and buttons; after the last
/// row it answers kEnd. open() restarts it. While the device is not open, read() and write() answer
/// kDisconnected. Deterministic.
class PALPATE_EXPORT ReplayDevice final : public Device {
 public:
  /// @throws Error (kInput) for no rows.
  ReplayDevice(std::vector<DeviceState> rows, DeviceInfo info,
               std::vector<InjectedFault> faults = {});

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override;
  /// The last force written [N].
  [[nodiscard]] const Vec3& lastForce() const noexcept { return force_; }

 private:
  std::vector<DeviceState> rows_;
  DeviceInfo info_;
  std::vector<InjectedFault> faults_;
  std::size_t next_ = 0;
  std::uint64_t reads_ = 0;
  bool is_open_ = false;
  Vec3 force_{0.0, 0.0, 0.0};
};

/// The readings of the record `file`, one for each tick. @throws Error (kInput) as RecordReader.
[[nodiscard]] PALPATE_EXPORT std::vector<DeviceState> readingsOf(const std::string& file);

}  // namespace palpate::devices
