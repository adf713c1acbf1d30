#pragma once
// The packets of a Novint Falcon. Protocol from public sources (libnifalcon), unverified on
// hardware.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpate::devices::falcon {

constexpr std::size_t kPacket = 16;  // [bytes] each way
constexpr int kMotorMost = 4096;     // [counts] that a motor takes

using Packet = std::array<std::uint8_t, kPacket>;

/// What the host says.
struct Command {
  std::array<int, 3> motors{};  ///< [counts] beyond kMotorMost: clamped
  bool homes = false;           ///< look for the origin
  bool red = false, green = false, blue = false;
};

/// What the device answers to one command.
struct Reply {
  std::array<int, 3> counts{};  ///< of the encoders
  unsigned buttons = 0;         ///< a bit each: 1 plus, 2 forward, 4 center, 8 minus
  unsigned homed = 0;           ///< a bit for each encoder; 7: all

  [[nodiscard]] bool isHomed() const noexcept { return homed == 7; }
};

[[nodiscard]] Packet encode(const Command& command) noexcept;

/// Bytes in, replies out. Whatever stands between two sound packets is dropped. A value; real-time
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
