#pragma once
/// A name for content: what was made of the same bytes by the same rules has the same.

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::vdb {

/// 128 bits of all that is added, in its order. Not a signature: it tells damage and change, not
/// forgery.
class ContentKey {
 public:
  /// A text with its length, so that "ab", "c" is not "a", "bc".
  ContentKey& add(std::string_view text);
  ContentKey& add(double value);
  /// Whole numbers, flags and enumerators.
  template <std::integral Whole>
  ContentKey& add(Whole value) {
    mix(static_cast<std::uint64_t>(value));
    return *this;
  }
  /// Bytes as they are; where they are cut into pieces counts.
  ContentKey& addBytes(const void* bytes, std::size_t count);
  /// All bytes of a file, but for the last `but` of them; false if they cannot be read. Stops as
  /// pollStop() does.
  bool addFile(const std::string& path, std::uint64_t but = 0);

  /// 32 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  void mix(std::uint64_t word) noexcept;

  std::array<std::uint64_t, 2> state_{0x243F6A8885A308D3U, 0xA4093822299F31D0U};
};

}  // namespace palpate::vdb
