#pragma once
// An emulated Falcon: its serial chip, boot ROM, firmware, motors, arms and the mass of its grip.

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::devices {

/// A firmware image in the format of the processor's boot ROM, containing only zeros and counters.
[[nodiscard]] std::vector<std::uint8_t> syntheticFirmware(std::size_t words = 4000);

/// The device behind the USB cable. Each command that the firmware answers takes 1 ms of virtual
/// time. Not for several threads.
class FalconEmulator {
 public:
  // Set by the test.
  bool has_firmware = true;
  unsigned homed = 7;
  unsigned buttons = 0;
  bool moves = true;                       ///< false: the grip is held where it is
  double mass = 0.2;                       ///< [kg]
  double damping = 2.0;                    ///< [Ns/m] damping by the hand
  double radians_per_count = 0.000635905;  ///< [rad] per count of the encoders
  std::function<Vec3(const Vec3&)> hand;   ///< [N] on the grip at a position; empty: none
  /// Called for each reply before it is sent; may damage it.
  std::function<void(std::vector<std::uint8_t>&)> damage;

  // Results of the driver's actions.
  std::array<int, 3> motors{};        ///< [counts] of the last command
  std::uint64_t commands = 0;         ///< number that were answered
  std::uint64_t moving_commands = 0;  ///< number with a nonzero motor
  std::uint64_t loaded = 0;           ///< bytes of firmware
  int latency = 16;                   ///< [ms]
  unsigned lights = 0;
  Vec3 felt{0.0};        ///< [N] force of the motors on the grip in the last command
  double quantum = 0.0;  ///< [N] at most, from half a count of each motor at that place

  FalconEmulator();
  void place(const Vec3& position);  ///< [m] in the base's frame, at rest
  [[nodiscard]] const Vec3& position() const noexcept { return position_; }
  [[nodiscard]] std::int64_t now() const noexcept { return now_; }  ///< [ns] of virtual time
  void pass(std::int64_t ns) noexcept { now_ += ns; }

  // The chip's interface.
  void control(std::uint8_t request, std::uint16_t value);
  void out(std::span<const std::uint8_t> bytes);
  /// One packet: two bytes with the modem's state, then at most 62 bytes of the device.
  [[nodiscard]] std::vector<std::uint8_t> in();

 private:
  void boot(std::uint8_t byte);
  void firmware(std::uint8_t byte);
  void answer();
  void move(double seconds);
  void encode();

  enum class Boot { kCold, kHello, kAutobaud, kLoading };
  Boot boot_ = Boot::kCold;
  unsigned baud_ = 0;
  std::vector<std::uint8_t> heard_;
  std::vector<std::uint8_t> image_;
  std::deque<std::uint8_t> to_host_;
  Vec3 position_{0.0, 0.0, 0.125};
  Vec3 velocity_{0.0};
  std::array<int, 3> counts_{};  ///< of the encoders, at the last reply
  std::atomic<std::int64_t> now_{0};
};

}  // namespace palpate::devices
