#pragma once
/// What is written from the vocabulary of scene files: the JSON Schema, the tables of the
/// documents, and help.

#include <string>
#include <string_view>
#include <vector>

#include "palpate/scene/vocabulary.h"

namespace palpate::tools {

/// The JSON Schema, draft 7, of scene files; ends with a newline.
[[nodiscard]] std::string schemaText(const Vocabulary& vocabulary);

/// A table in Markdown of the keys of `map`; of "in_code" the kinds of fields and the functions
/// that make them.
/// @throws Error (kUsage) if there is no such map.
[[nodiscard]] std::string keyTable(const Vocabulary& vocabulary, std::string_view map);

/// Help for people: of a map, of a key wherever it may stand, or of MAP.KEY; everything for "".
/// @throws Error (kUsage) with a suggestion if nothing is called so.
[[nodiscard]] std::string sceneHelp(const Vocabulary& vocabulary, const std::string& word);

/// What sceneHelp() knows, in alphabetical order.
[[nodiscard]] std::vector<std::string> sceneWords(const Vocabulary& vocabulary);

/// "length, more than 0", "`a`, `b`", "`{radius, depth}`": what may stand at a key.
[[nodiscard]] std::string valueText(const Vocabulary& vocabulary, const KeyWords& key);

}  // namespace palpate::tools
