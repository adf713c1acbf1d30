#pragma once
// A thread that releases the hand when the servo thread hangs.

#include <atomic>
#include <cstdint>
#include <thread>

#include "palpate/devices/device.h"

namespace palpate::devices {

/// True if the last turn of the loop is `longest` [ns] old.
[[nodiscard]] constexpr bool isHung(std::int64_t now, std::int64_t beat,
                                    std::int64_t longest) noexcept {
  return now - beat >= longest;
}

/// While this object exists and the last beat() is too old, it calls the device's cut() again and
/// again, since a device may forget an earlier cut. One thread calls beat() and cuts().
class HangWatch {
 public:
  /// `longest` [ns] is permitted between two beats; with the largest possible number no thread is
  /// started. The device must be open and stay so. `above` is a real-time priority that the thread
  /// tries to get, or 0 for none: a loop that spins must not starve it.
  /// @throws Error (kOperation) if the thread cannot be started.
  HangWatch(Device& device, std::int64_t longest, int above);
  ~HangWatch();
  HangWatch(const HangWatch&) = delete;
  HangWatch& operator=(const HangWatch&) = delete;

  // The functions from here on are real-time safe.

  /// A turn of the loop ended at `now` [ns, monotonic].
  void beat(std::int64_t now) noexcept { beat_.store(now, std::memory_order_release); }
  [[nodiscard]] std::int64_t lastBeat() const noexcept {
    return beat_.load(std::memory_order_relaxed);
  }
  /// Number of cuts of the device.
  [[nodiscard]] std::uint64_t cuts() const noexcept {
    return cuts_.load(std::memory_order_acquire);
  }

 private:
  void run(int priority) noexcept;

  Device& device_;
  std::int64_t longest_;
  std::atomic<std::int64_t> beat_;
  std::atomic<std::uint64_t> cuts_{0};
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace palpate::devices
