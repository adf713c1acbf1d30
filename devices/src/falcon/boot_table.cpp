#include "falcon/boot_table.h"

#include <fstream>
#include <iterator>

#include "palpate/core/error.h"

namespace palpate::devices::falcon {
namespace {

constexpr std::uint16_t kKey = 0x08AA;     // eight bits at a time
constexpr std::size_t kReserved = 8;       // [words]
constexpr std::size_t kLargest = 1 << 20;  // [bytes] more than the processor's memory

class Words {
 public:
  Words(std::span<const std::uint8_t> bytes, const std::string& file)
      : bytes_(bytes), file_(file) {}

  [[nodiscard]] std::uint16_t next(const char* what) {
    if (at_ + 2 > bytes_.size()) {
      throw bad("it ends at byte " + std::to_string(bytes_.size()) + ", in " + what);
    }
    const auto word = static_cast<std::uint16_t>(bytes_[at_] | (bytes_[at_ + 1] << 8));
    at_ += 2;
    return word;
  }
  void skip(std::size_t words, const char* what) {
    for (std::size_t i = 0; i < words; ++i) (void)next(what);
  }
  [[nodiscard]] std::uint32_t address(const char* what) {
    const std::uint32_t high = next(what);
    return (high << 16) | next(what);
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] Error bad(const std::string& why) const {
    return inputError("falcon.firmware", "this is not a firmware image of the Falcon: " + why,
                      "give the .bin of the firmware itself; nothing was sent to the device",
                      file_);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

}  // namespace

BootTable readBootTable(std::span<const std::uint8_t> image, const std::string& file) {
  Words words(image, file);
  BootTable out;
  if (words.next("the key") != kKey) throw words.bad("it does not begin with the key AA 08");
  words.skip(kReserved, "the reserved words");
  out.entry = words.address("the entry point");
  while (const std::uint16_t count = words.next("the size of a block")) {
    (void)words.address("the address of a block");
    words.skip(count, "a block");
    ++out.blocks;
    out.words += count;
  }
  if (out.blocks == 0) throw words.bad("it holds no block");
  if (words.left() > 0) {
    throw words.bad(std::to_string(words.left()) + " bytes follow the last block, at byte " +
                    std::to_string(words.at()));
  }
  return out;
}

std::vector<std::uint8_t> readFirmware(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw inputError("falcon.firmware", "cannot open the firmware image", "", file);
  std::vector<std::uint8_t> bytes;
  for (char c = 0; bytes.size() <= kLargest && in.get(c);) {
    bytes.push_back(static_cast<std::uint8_t>(c));
  }
  if (bytes.size() > kLargest) {
    throw inputError("falcon.firmware", "this is too large for a firmware image: over 1 MiB", "",
                     file);
  }
  (void)readBootTable(bytes, file);
  return bytes;
}

}  // namespace palpate::devices::falcon
