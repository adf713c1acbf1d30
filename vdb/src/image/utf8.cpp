#include "image/utf8.h"

#include <cstddef>

namespace palpate::vdb {
namespace {

/// Number of bytes of the UTF-8 character at the front of `text`; 0 if there is none. Overlong
/// forms, surrogates and code points beyond U+10FFFF are not UTF-8.
std::size_t characterAtFront(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned char second = byte(1);
  if ((first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second > 0x9FU) ||
      (first == 0xF0U && second < 0x90U) || (first == 0xF4U && second > 0x8FU)) {
    return 0;
  }
  return length;
}

}  // namespace

std::string asUtf8(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = characterAtFront(rest);
    if (length > 0) {
      rest.remove_prefix(length);
      continue;
    }
    std::string out;
    for (const char c : text) {
      const auto code = static_cast<unsigned char>(c);
      if (code < 0x80U) {
        out += c;
      } else {
        out += static_cast<char>(0xC0U | (code >> 6U));
        out += static_cast<char>(0x80U | (code & 0x3FU));
      }
    }
    return out;
  }
  return std::string(text);
}

}  // namespace palpate::vdb
