#pragma once
/// Labels in the form that options use.

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace palpate::tools {

/// First and last of "5-28"; twice the number for "7"; nothing for any other text.
[[nodiscard]] inline std::optional<std::pair<int, int>> labelRange(std::string_view text) {
  const auto whole = [](std::string_view part) -> std::optional<int> {
    int value = 0;
    const char* const end = part.data() + part.size();
    const auto [stop, failure] = std::from_chars(part.data(), end, value);
    if (failure != std::errc{} || stop != end || value < 0) return std::nullopt;
    return value;
  };
  const std::size_t dash = text.find('-');
  const auto first = whole(text.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : whole(text.substr(dash + 1));
  if (!first || !last) return std::nullopt;
  return std::pair(*first, *last);
}

}  // namespace palpate::tools
