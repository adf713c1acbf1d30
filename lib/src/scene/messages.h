#pragma once
/// How values of a file are shown in messages.

#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/text.h"

namespace palpate {

/// "a, b, c": for hints that list the available names; cut off after 32.
[[nodiscard]] std::string listed(const std::vector<std::string_view>& names);

/// "did you mean 'x'?" if one of the names is close; else `lead` and the names; "" without names.
[[nodiscard]] std::string suggestOrList(std::string_view word,
                                        const std::vector<std::string_view>& names,
                                        std::string_view lead);

}  // namespace palpate
