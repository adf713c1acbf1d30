#pragma once
// A firmware image in the format that the boot ROM of a TI C28x processor accepts over its serial
// port.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate::devices::falcon {

/// The contents of an image's header.
struct BootTable {
  std::uint32_t entry = 0;  ///< address where the program begins
  int blocks = 0;
  std::size_t words = 0;  ///< of 16 bits, in all blocks
};

/// Reads the table without using it: key 0x08AA, 8 words, entry, blocks of {count, address, words},
/// count 0, and nothing after that.
/// @throws Error (kInput), naming `file`, if it is not a boot table.
[[nodiscard]] BootTable readBootTable(std::span<const std::uint8_t> image, const std::string& file);

/// The bytes of `file`, checked. @throws Error (kInput).
[[nodiscard]] std::vector<std::uint8_t> readFirmware(const std::string& file);

}  // namespace palpate::devices::falcon
