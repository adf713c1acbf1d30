#pragma once
// A firmware image as the boot ROM of a TI C28x processor takes it over its serial port.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate::devices::falcon {

/// What an image says of itself.
struct BootTable {
  std::uint32_t entry = 0;  ///< address where the program begins
  int blocks = 0;
  std::size_t words = 0;  ///< of 16 bits, in all blocks
};

/// Reads the table without using it: key 0x08AA, 8 words, entry, blocks of {count, address, words},
/// count 0, and nothing after.
/// @throws Error (kInput), naming `file`, if it is not a boot table.
[[nodiscard]] BootTable readBootTable(std::span<const std::uint8_t> image, const std::string& file);

/// The bytes of `file`, checked. @throws Error (kInput).
[[nodiscard]] std::vector<std::uint8_t> readFirmware(const std::string& file);

}  // namespace palpate::devices::falcon
