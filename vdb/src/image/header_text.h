#pragma once
/// Parsing shared by headers that consist of text lines.

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/vdb/text.h"

namespace palpate::vdb {

/// The words between runs of blanks.
[[nodiscard]] std::vector<std::string_view> wordsOf(std::string_view text);

/// The whole text as a number; nothing if it is not a number. A leading + is allowed.
template <typename Number>
[[nodiscard]] std::optional<Number> numberIn(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// All words as numbers; nothing if one of them is not a number.
template <typename Number>
[[nodiscard]] std::optional<std::vector<Number>> numbersIn(std::string_view text) {
  std::vector<Number> numbers;
  for (const std::string_view word : wordsOf(text)) {
    const auto number = numberIn<Number>(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace palpate::vdb
