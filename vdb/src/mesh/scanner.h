#pragma once
/// Reads words and numbers of a text, with their line numbers, and binary numbers between them.

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>

#include "palpate/core/math.h"
#include "scalar.h"

namespace palpate::vdb {

struct Scanner {
  std::string_view text;
  std::size_t at = 0;
  int line = 1;

  static bool isBlank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void skipBlanks() noexcept {
    while (at < text.size() && isBlank(text[at])) line += text[at++] == '\n' ? 1 : 0;
  }

  /// The next word, on this or a later line; empty at the end.
  std::string_view word() noexcept {
    skipBlanks();
    return take();
  }

  /// The next word of this line; empty at its end.
  std::string_view wordOfLine() noexcept {
    while (at < text.size() && text[at] != '\n' && isBlank(text[at])) ++at;
    return at < text.size() && text[at] == '\n' ? std::string_view() : take();
  }

  /// The next binary number; nothing if the data end before it is complete.
  std::optional<double> number(Scalar kind, bool is_swapped) noexcept {
    return withKind(kind, [&](auto value) -> std::optional<double> {
      if (text.size() - at < sizeof value) return {};
      char raw[sizeof value];
      std::memcpy(raw, text.data() + at, sizeof raw);
      at += sizeof raw;
      if (is_swapped) std::reverse(raw, raw + sizeof raw);
      std::memcpy(&value, raw, sizeof raw);
      return static_cast<double>(value);
    });
  }

  /// Skips to the end of this line.
  void skipLine() noexcept {
    while (at < text.size() && text[at] != '\n') ++at;
  }

 private:
  std::string_view take() noexcept {
    const std::size_t begin = at;
    while (at < text.size() && !isBlank(text[at])) ++at;
    return text.substr(begin, at - begin);
  }
};

/// The whole word as a number; infinite if it is too large; nothing if it is not a number.
inline std::optional<double> numberOf(std::string_view word) noexcept {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const char* const end_of_word = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), end_of_word, value);
  if (error == std::errc::invalid_argument || end != end_of_word) return {};
  return error == std::errc::result_out_of_range ? kInfinity : value;
}

}  // namespace palpate::vdb
