#pragma once
/// Texts generated from the vocabulary of scene files: the JSON Schema, the tables of the
/// documents, and help.

#include <string>
#include <string_view>
#include <vector>

#include "palpate/scene/vocabulary.h"

namespace palpate::tools {

/// The JSON Schema, draft 7, of scene files; ends with a newline.
[[nodiscard]] std::string schemaText(const Vocabulary& vocabulary);

/// A Markdown table of the keys of `map`; for "in_code" the kinds of fields, with the functions
/// that make them.
/// @throws Error (kUsage) if there is no such map.
[[nodiscard]] std::string keyTable(const Vocabulary& vocabulary, std::string_view map);

/// Help for people: on a map, on a key wherever it may stand, or on MAP.KEY; on everything for "".
/// @throws Error (kUsage) with a suggestion if nothing has this name.
[[nodiscard]] std::string sceneHelp(const Vocabulary& vocabulary, const std::string& word);

/// All words that sceneHelp() accepts, in alphabetical order.
[[nodiscard]] std::vector<std::string> sceneWords(const Vocabulary& vocabulary);

/// The values that a key may have: "length, more than 0", "`a`, `b`", "`{radius, depth}`".
[[nodiscard]] std::string valueText(const Vocabulary& vocabulary, const KeyWords& key);

}  // namespace palpate::tools
