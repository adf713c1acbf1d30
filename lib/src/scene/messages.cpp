#include "scene/messages.h"

#include <algorithm>
#include <span>

#include "palpate/scene/suggestion.h"

namespace palpate {

std::string listed(const std::vector<std::string_view>& names) {
  constexpr std::size_t kShown = 32;
  std::string text = joined(std::span(names).first(std::min(names.size(), kShown)));
  if (names.size() > kShown) text += ", ... (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string suggestOrList(std::string_view word, const std::vector<std::string_view>& names,
                          std::string_view lead) {
  return suggestionFor(word, names, names.empty() ? "" : std::string(lead) + listed(names));
}

}  // namespace palpate
