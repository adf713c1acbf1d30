#pragma once
// The packets of a Novint Falcon. Protocol from public sources (libnifalcon), unverified on
// hardware.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpate::devices::falcon {

constexpr std::size_t kPacket = 16;  // [bytes] in each direction
constexpr int kMotorMost = 4096;     // [counts] the most that a motor accepts

using Packet = std::array<std::uint8_t, kPacket>;

/// A command from the host.
struct Command {
  std::array<int, 3> motors{};  ///< [counts] clamped to kMotorMost
  bool homes = false;           ///< search for the origin
  bool red = false, green = false, blue = false;
};

/// The device's answer to one command.
struct Reply {
  std::array<int, 3> counts{};  ///< of the encoders
  unsigned buttons = 0;         ///< one bit each: 1 plus, 2 forward, 4 center, 8 minus
  unsigned homed = 0;           ///< one bit for each encoder; 7: all

  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

[[nodiscard]] Packet encode(const Command& command) noexcept;

/// Turns bytes into replies. Bytes between two sound packets are dropped. A value type; real-time
/// safe.
class Parser {
 public:
  [[nodiscard]] std::optional<Reply> push(std::uint8_t byte) noexcept;
  /// Bytes that were not part of a reply.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  [[nodiscard]] bool fits(std::uint8_t byte) const noexcept;
  [[nodiscard]] Reply decode() const noexcept;

  Packet bytes_{};
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate::devices::falcon
