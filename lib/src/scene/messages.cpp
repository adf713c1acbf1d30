#include "scene/messages.h"

#include <algorithm>
#include <span>

#include "palpate/scene/scene_file.h"

namespace palpate {

std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t kShown = 32;
  std::string text = joined(std::span(names).first(std::min(names.size(), kShown)));
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
