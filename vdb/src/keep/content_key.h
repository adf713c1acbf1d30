#pragma once
/// A key for content: results made from the same bytes by the same rules have the same key.

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::vdb {

/// 128 bits that depend on everything added, and on its order. Not a signature: it shows damage and
/// change, not forgery.
class ContentKey {
 public:
  /// A text with its length, so that "ab", "c" differs from "a", "bc".
  ContentKey& add(std::string_view text);
  ContentKey& add(double value);
  /// Integers, flags and enumerators.
  template <std::integral Whole>
  ContentKey& add(Whole value) {
    mix(static_cast<std::uint64_t>(value));
    return *this;
  }
  /// Raw bytes; dividing them differently changes the key.
  ContentKey& addBytes(const void* bytes, std::size_t count);
  /// All bytes of a file except its last `but` bytes; false if they cannot be read. Stops as
  /// pollStop() does.
  bool addFile(const std::string& path, std::uint64_t but = 0);

  /// 32 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  void mix(std::uint64_t word) noexcept;

  std::array<std::uint64_t, 2> state_{0x243F6A8885A308D3U, 0xA4093822299F31D0U};
};

}  // namespace palpate::vdb
