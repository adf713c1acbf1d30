#pragma once
/// The hint for a name that is not known.

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/core/text.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// "did you mean 'x'?" if the name of one of `items` is close to `word`, else `otherwise`. `name`
/// is the member that holds an item's name.
template <typename Items, typename Name = std::identity>
[[nodiscard]] std::string suggestionFor(std::string_view word, const Items& items,
                                        std::string otherwise = {}, Name name = {}) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.emplace_back(std::invoke(name, item));
  const std::string close = suggest(word, names);
  return close.empty() ? std::move(otherwise) : "did you mean " + inQuotes(close) + "?";
}

}  // namespace palpate
