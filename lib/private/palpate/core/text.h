#pragma once
/// Numbers, names and lists, as messages write them.

#include <functional>
#include <string>
#include <string_view>

#include "palpate/export.h"

namespace palpate {

/// `value` with at most `digits` significant digits.
[[nodiscard]] PALPATE_EXPORT std::string shortNumber(double value, int digits);
/// `value` with as few digits as read back exactly.
[[nodiscard]] PALPATE_EXPORT std::string exactNumber(double value);

/// `text` in single quotes, on one line and cut off if it is too long.
[[nodiscard]] PALPATE_EXPORT std::string inQuotes(std::string_view text);

/// "a, b, c": what `shown`, a function or a member, gives for each item. Items for which that is
/// empty are left out.
template <typename Items, typename Shown = std::identity>
[[nodiscard]] std::string joined(const Items& items, std::string_view between = ", ",
                                 Shown shown = {}) {
  std::string text;
  for (const auto& item : items) {
    const auto& part = std::invoke(shown, item);
    const std::string_view one = part;
    if (!text.empty() && !one.empty()) text += between;
    text += one;
  }
  return text;
}

}  // namespace palpate
