// Packets of the Falcon: every value encoded and decoded, and garbage between packets.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "falcon/packet.h"

namespace palpate::devices::falcon {
namespace {

/// A device's reply, encoded independently: the nibbles as letters, the lowest first.
std::vector<std::uint8_t> replyBytes(const std::array<int, 3>& counts, unsigned flags) {
  std::vector<std::uint8_t> out = {'<'};
  for (const int count : counts) {
    int rest = count < 0 ? count + 65536 : count;
    for (int k = 0; k < 4; ++k) {
      out.push_back(static_cast<std::uint8_t>("ABCDEFGHIJKLMNOP"[rest % 16]));
      rest /= 16;
    }
  }
  out.push_back(static_cast<std::uint8_t>('A' + flags));
  out.push_back('A');
  out.push_back('>');
  return out;
}

std::vector<Reply> parse(Parser& parser, const std::vector<std::uint8_t>& bytes) {
  std::vector<Reply> out;
  for (const std::uint8_t byte : bytes) {
    if (const auto reply = parser.push(byte)) out.push_back(*reply);
  }
  return out;
}

TEST(FalconPacket, TheIdlePacketIsTheOneOfTheDocuments) {
  const Packet packet = encode({});
  EXPECT_EQ(std::string(packet.begin(), packet.end()), "<AAAAAAAAAAAAAA>");
}

TEST(FalconPacket, EveryMotorValueIsWrittenAndNoneWraps) {
  for (int value = -70'000; value <= 70'000; ++value) {
    Command command;
    command.motors = {value, -value, 0};
    const Packet packet = encode(command);
    const int clamped = std::clamp(value, -4096, 4096);
    const auto wanted = replyBytes({clamped, -clamped, 0}, 0);
    ASSERT_TRUE(std::equal(packet.begin(), packet.end(), wanted.begin())) << value;
  }
}

TEST(FalconPacket, LightsAndHomingHaveTheBitsThatRanOnHardware) {
  Command command;
  command.homes = true;
  EXPECT_EQ(encode(command)[13], 'B');
  command = {.green = true};
  EXPECT_EQ(encode(command)[13], 'C');
  command = {.blue = true};
  EXPECT_EQ(encode(command)[13], 'E');
  command = {.red = true};
  EXPECT_EQ(encode(command)[13], 'I');
}

TEST(FalconPacket, EveryEncoderValueAndEveryFlagIsRead) {
  Parser parser;
  for (int value = -32'768; value <= 32'767; ++value) {
    const auto replies = parse(parser, replyBytes({value, 17, -value - 1}, 0));
    ASSERT_EQ(replies.size(), 1U);
    ASSERT_EQ(replies[0].counts, (std::array<int, 3>{value, 17, -value - 1}));
  }
  for (unsigned flags = 0; flags < 128; ++flags) {
    const auto replies = parse(parser, replyBytes({0, 0, 0}, flags));
    ASSERT_EQ(replies.size(), 1U);
    EXPECT_EQ(replies[0].buttons, flags % 16);
    EXPECT_EQ(replies[0].homed, flags / 16);
    EXPECT_EQ(replies[0].isHomed(), flags >= 112);
  }
  EXPECT_EQ(parser.dropped(), 0U);
}

TEST(FalconPacket, AShortPacketIsDroppedAndTheNextIsRead) {
  const auto whole = replyBytes({300, -2, 5}, 112);
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    std::vector<std::uint8_t> bytes(whole.begin(), whole.begin() + static_cast<long>(kept));
    bytes.insert(bytes.end(), whole.begin(), whole.end());
    Parser parser;
    const auto replies = parse(parser, bytes);
    ASSERT_EQ(replies.size(), 1U) << kept;
    EXPECT_EQ(replies[0].counts, (std::array<int, 3>{300, -2, 5}));
    EXPECT_EQ(parser.dropped(), kept);
  }
}

TEST(FalconPacket, AByteThatCannotBeMakesAPacketNone) {
  const auto whole = replyBytes({300, -2, 5}, 112);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      auto bytes = whole;
      bytes[at] = static_cast<std::uint8_t>(byte);
      const bool is_data = at > 0 && at < 15;
      const int most = at == 13 ? 0xC0 : 0x50;
      const bool fits = is_data ? byte >= 0x41 && byte <= most : byte == whole[at];
      Parser parser;
      ASSERT_EQ(parse(parser, bytes).size(), fits ? 1U : 0U) << at << " " << byte;
    }
  }
}

/// Bytes as they may come over a line: packets, damaged ones, and garbage. Does not allocate, which
/// would be slow under the sanitizers.
class AnyBytes {
 public:
  explicit AnyBytes(unsigned seed) : random_(seed) {}

  [[nodiscard]] std::span<const std::uint8_t> next() {
    const unsigned kind = random_() % 4;
    if (kind < 2) {
      bytes_[0] = '<';
      for (std::size_t k = 1; k < 15; ++k)
        bytes_[k] = static_cast<std::uint8_t>('A' + random_() % 16);
      bytes_[13] = static_cast<std::uint8_t>('A' + random_() % 128);
      bytes_[15] = '>';
      if (kind == 1) bytes_[random_() % 16] = static_cast<std::uint8_t>(random_());
      return std::span(bytes_).first(16);
    }
    const std::size_t size = random_() % bytes_.size();
    for (std::size_t k = 0; k < size; ++k) {
      const auto any = static_cast<std::uint8_t>(random_());
      bytes_[k] = kind == 2 ? static_cast<std::uint8_t>("<>AP@Q"[any % 6]) : any;
    }
    return std::span(bytes_).first(size);
  }

 private:
  std::minstd_rand random_;
  std::array<std::uint8_t, 20> bytes_{};
};

/// Keeps the bytes from the last '<' on, at most 16, and tells whether they are a packet.
class Window {
 public:
  bool completes(std::uint8_t byte) {
    if (byte == '<') size_ = 0;
    if (size_ < bytes_.size()) bytes_[size_] = byte;
    size_ = std::min(size_ + 1, bytes_.size() + 1);
    bool is_packet =
        size_ == 16 && bytes_[0] == '<' && byte == '>' && bytes_[13] >= 0x41 && bytes_[13] <= 0xC0;
    for (std::size_t k = 1; is_packet && k < 15; ++k) {
      if (k != 13) is_packet = bytes_[k] >= 0x41 && bytes_[k] <= 0x50;
    }
    return is_packet;
  }

 private:
  std::array<std::uint8_t, 16> bytes_{};
  std::size_t size_ = 0;
};

TEST(FalconPacket, OfTenMillionInputsNoWholePacketIsLostAndNoneInvented) {
  const unsigned seed = 91;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  AnyBytes any(seed);
  Parser parser;
  Window window;
  std::uint64_t read = 0;
  std::uint64_t bytes = 0;
  constexpr int kInputs = 10'000'000;
  for (int i = 0; i < kInputs; ++i) {
    for (const std::uint8_t byte : any.next()) {
      // A reply must come exactly where the window is a packet, since no sound packet contains the
      // beginning of another.
      const auto reply = parser.push(byte);
      if (reply.has_value() != window.completes(byte)) FAIL() << "input " << i;
      read += reply ? 1 : 0;
      ++bytes;
    }
  }
  // Except for a packet that has only begun.
  EXPECT_LE(parser.dropped() + 16 * read, bytes);
  EXPECT_GT(parser.dropped() + 16 * read + 16, bytes);
  EXPECT_GT(read, kInputs / 5U);
  std::printf("%d inputs, %llu bytes, %llu packets\n", kInputs,
              static_cast<unsigned long long>(bytes), static_cast<unsigned long long>(read));
}

TEST(FalconPacket, OfTenMillionCommandsEachIsAPacketThatReadsBackAsItWasClamped) {
  std::mt19937 random(92);
  Parser parser;
  constexpr int kInputs = 10'000'000;
  for (int i = 0; i < kInputs; ++i) {
    Command command;
    for (int& motor : command.motors) {
      // Values of all sizes, up to the ends of the range.
      motor = static_cast<std::int32_t>(random()) >> (random() % 32);
    }
    command.homes = random() % 2 == 0;
    command.green = random() % 2 == 0;
    std::optional<Reply> back;
    for (const std::uint8_t byte : encode(command)) back = parser.push(byte);
    if (!back) FAIL() << "input " << i;
    for (std::size_t k = 0; k < 3; ++k) {
      if (back->counts[k] != std::clamp(command.motors[k], -4096, 4096)) FAIL() << "input " << i;
    }
  }
  EXPECT_EQ(parser.dropped(), 0U);
}

}  // namespace
}  // namespace palpate::devices::falcon
