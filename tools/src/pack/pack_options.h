#pragma once
/// The options of `palpate pack`.

#include <string>
#include <utility>
#include <variant>

#include "options.h"

namespace palpate::tools {

struct PackOptions {
  std::string scene;
  std::string output;  ///< a folder
};

template <class... Verbs>
auto withPack(const std::variant<Verbs...>&) -> std::variant<Verbs..., PackOptions>;

/// Options of any verb.
using AnyOptions = decltype(withPack(std::declval<VerbOptions>()));

}  // namespace palpate::tools
