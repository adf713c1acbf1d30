#include "scene/messages.h"

#include <algorithm>

#include "palpate/scene/scene_file.h"

namespace palpate {

std::string inQuotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::size_t end = std::min(text.size(), kShown);
  // Not in the middle of a character.
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;
  }
  std::string shown = "'";
  for (const char c : text.substr(0, end)) {
    shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
  }
  if (end < text.size()) shown += "...";
  return shown + "'";
}

std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t kShown = 32;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  if (names.size() > kShown) text += ", ... (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string suggestOrList(std::string_view word, const std::vector<std::string_view>& names,
                          std::string_view lead) {
  const std::string close = suggest(word, names);
  if (!close.empty()) return "did you mean " + inQuotes(close) + "?";
  if (names.empty()) return {};
  return std::string(lead) + listed(names);
}

}  // namespace palpate
