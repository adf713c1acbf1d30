// Packets of the Falcon: every value there and back, and garbage between them.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "falcon/packet.h"

namespace palpate::devices::falcon {
namespace {

/// The reply of a device, written down anew: letters of nibbles, the lowest first.
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

TEST(FalconPacket, TenMillionBytesOfGarbageLoseNoWholePacketAndInventNone) {
  const unsigned seed = 91;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  Parser parser;
  std::vector<std::uint8_t> taken;  // since the last '<'
  std::uint64_t read = 0;
  std::uint64_t whole = 0;
  constexpr int kBytes = 10'000'000;
  for (int i = 0; i < kBytes;) {
    std::vector<std::uint8_t> piece;
    const unsigned kind = random() % 4;
    if (kind == 0) {
      piece = replyBytes({static_cast<int>(random() % 65536) - 32768, 0, 1}, random() % 128);
    } else if (kind == 1) {
      piece = replyBytes({1, 2, 3}, 0);
      piece[random() % 16] = static_cast<std::uint8_t>(random());
    } else if (kind == 2) {
      for (auto n = random() % 20; n > 0; --n)
        piece.push_back(static_cast<std::uint8_t>("<>AP@Q"[random() % 6]));
    } else {
      for (auto n = random() % 20; n > 0; --n) piece.push_back(static_cast<std::uint8_t>(random()));
    }
    for (const std::uint8_t byte : piece) {
      // A window of 16 bytes that is a packet is one, as no sound packet holds another's beginning.
      if (byte == '<') taken.clear();
      taken.push_back(byte);
      bool is_packet = taken.size() == 16 && taken[0] == '<' && byte == '>' && taken[13] >= 0x41 &&
                       taken[13] <= 0xC0;
      for (std::size_t k = 1; is_packet && k < 15; ++k) {
        if (k != 13) is_packet = taken[k] >= 0x41 && taken[k] <= 0x50;
      }
      whole += is_packet ? 1 : 0;
      const auto reply = parser.push(byte);
      ASSERT_EQ(reply.has_value(), is_packet);
      read += reply ? 1 : 0;
      ++i;
    }
  }
  EXPECT_EQ(read, whole);
  EXPECT_GT(read, 100'000U);
}

}  // namespace
}  // namespace palpate::devices::falcon
