#include "falcon/packet.h"

#include <algorithm>

namespace palpate::devices::falcon {
namespace {

constexpr std::uint8_t kBegin = '<';
constexpr std::uint8_t kEnd = '>';
constexpr std::uint8_t kZero = 'A';  // a nibble n is the letter kZero + n
constexpr std::size_t kFlags = 13;   // the byte with lights, buttons and homing
constexpr unsigned kMostFlags = 0x7F;

// Bits for lights and homing, as libnifalcon's code sends them (its comments state other bits).
constexpr unsigned kHomes = 1;
constexpr unsigned kGreen = 2;
constexpr unsigned kBlue = 4;
constexpr unsigned kRed = 8;

}  // namespace

Packet encode(const Command& command) noexcept {
  Packet out{};
  out[0] = kBegin;
  for (std::size_t i = 0; i < 3; ++i) {
    const int clamped = std::clamp(command.motors[i], -kMotorMost, kMotorMost);
    const auto bits = static_cast<std::uint16_t>(clamped);
    for (std::size_t k = 0; k < 4; ++k) {
      const unsigned nibble = (static_cast<unsigned>(bits) >> (4 * k)) & 15U;
      out[1 + 4 * i + k] = static_cast<std::uint8_t>(kZero + nibble);
    }
  }
  const unsigned flags = (command.homes ? kHomes : 0U) | (command.green ? kGreen : 0U) |
                         (command.blue ? kBlue : 0U) | (command.red ? kRed : 0U);
  out[kFlags] = static_cast<std::uint8_t>(kZero + flags);
  out[14] = kZero;
  out[15] = kEnd;
  return out;
}

bool Parser::fits(std::uint8_t byte) const noexcept {
  if (size_ == 0) return byte == kBegin;
  if (size_ == kPacket - 1) return byte == kEnd;
  if (byte < kZero) return false;
  return static_cast<unsigned>(byte - kZero) <= (size_ == kFlags ? kMostFlags : 15U);
}

Reply Parser::decode() const noexcept {
  Reply out;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      bits |= static_cast<unsigned>(bytes_[1 + 4 * i + k] - kZero) << (4 * k);
    }
    out.counts[i] = static_cast<std::int16_t>(bits);
  }
  const auto flags = static_cast<unsigned>(bytes_[kFlags] - kZero);
  out.buttons = flags & 15U;
  out.homed = (flags >> 4) & 7U;
  return out;
}

std::optional<Reply> Parser::push(std::uint8_t byte) noexcept {
  if (!fits(byte)) {
    // The bytes so far are not a packet, but a packet may begin with this byte.
    dropped_ += size_;
    size_ = 0;
    if (byte != kBegin) {
      ++dropped_;
      return std::nullopt;
    }
  }
  bytes_[size_++] = byte;
  if (size_ < kPacket) return std::nullopt;
  size_ = 0;
  return decode();
}

}  // namespace palpate::devices::falcon
