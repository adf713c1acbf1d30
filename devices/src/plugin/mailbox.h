#pragma once
// Exchanges values between the servo thread and a thread that talks to a device: the last reading
// in one direction, the last force in the other.

#include <cstdint>

#include "palpate/devices/device.h"
#include "palpate/devices/seq_lock.h"

namespace palpate::devices::plugin {

/// A message from the device's thread.
struct Letter {
  std::uint64_t number = 0;  ///< of the reading, from 1
  DeviceStatus status = DeviceStatus::kStale;
  DeviceState state;
};

/// A message from the servo thread.
struct Order {
  std::uint64_t number = 0;   ///< of the write, from 1
  Vec3 force{0.0, 0.0, 0.0};  ///< [N]
};

class Mailbox {
 public:
  // For the servo thread; real time.

  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept {
    const auto letter = readings_.load();
    if (!letter) return DeviceStatus::kStale;
    // A status other than a reading stays until the device is opened again.
    if (letter->status != DeviceStatus::kOk) return letter->status;
    if (letter->number == seen_) return DeviceStatus::kStale;
    seen_ = letter->number;
    out = letter->state;
    return DeviceStatus::kOk;
  }
  void write(const Vec3& force) noexcept { orders_.store({++written_, force}); }

  // For the device's thread.

  void say(DeviceStatus status, const DeviceState& state) noexcept {
    readings_.store({++said_, status, state});
  }
  /// The force of the last write; zero if it came `patience` calls ago or more.
  [[nodiscard]] Vec3 force(int patience) noexcept {
    const auto order = orders_.load();
    if (!order) return Vec3(0.0);
    old_ = order->number == answered_ ? old_ + 1 : 0;
    answered_ = order->number;
    return old_ >= patience ? Vec3(0.0) : order->force;
  }

 private:
  SeqLock<Letter> readings_;
  SeqLock<Order> orders_;
  std::uint64_t seen_ = 0;
  std::uint64_t written_ = 0;
  std::uint64_t said_ = 0;
  std::uint64_t answered_ = 0;
  int old_ = 0;
};

}  // namespace palpate::devices::plugin
