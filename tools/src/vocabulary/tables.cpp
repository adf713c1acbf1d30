#include <algorithm>
#include <set>

#include "palpate/core/error.h"
#include "vocabulary/documents.h"

namespace palpate::tools {
namespace {

using Form = KeyWords::Form;
using Count = KeyWords::Count;

/// Maps that have a table of their own; the keys of other maps are explained where they are used.
constexpr std::string_view kTables[] = {"field_kind", "image", "material", "layer",
                                        "wall",       "port",  "sheet"};

bool isSpelledOut(const KeyWords& key) {
  return key.form == Form::kMap && key.count != Count::kNames &&
         std::find(std::begin(kTables), std::end(kTables), key.type) == std::end(kTables);
}

std::string quotedList(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "`" : ", `") + word + "`";
  return text;
}

std::string keysOf(const Vocabulary& vocabulary, const KeyWords& key) {
  std::string text;
  for (const KeyWords& inner : vocabulary.find(key.type)->keys) {
    text += (text.empty() ? "`{" : ", ") + inner.name;
  }
  return text.empty() ? "map" : text + "}`";
}

std::string oneText(const Vocabulary& vocabulary, const KeyWords& key) {
  if (!key.value.empty()) return key.value;
  switch (key.form) {
    case Form::kChoice:
      return quotedList(key.choices);
    case Form::kBoolean:
      return "`true`, `false`";
    case Form::kMap:
      return isSpelledOut(key) ? keysOf(vocabulary, key) : key.type;
    default:
      break;
  }
  std::string text = key.form == Form::kWhole ? "" : key.type;
  std::replace(text.begin(), text.end(), '_', ' ');
  const std::string bounds = boundsText(key);
  if (!bounds.empty()) text += (text.empty() ? "" : ", ") + bounds;
  return text;
}

/// The meaning of a key, and of the keys of the map that it holds; each map is explained once.
std::string meaning(const Vocabulary& vocabulary, const KeyWords& key, std::set<std::string>& told,
                    bool is_inner = false) {
  std::string text = key.help;
  if (!key.needs.empty()) text += (text.empty() ? "needs " : "; needs ") + key.needs;
  if (!key.more.empty()) text += ". " + key.more;
  if (!isSpelledOut(key) || !told.insert(key.type).second) return text;
  std::string inner;
  for (const KeyWords& part : vocabulary.find(key.type)->keys) {
    inner += (inner.empty() ? "" : "; ") + ("`" + part.name + "` (") + valueText(vocabulary, part);
    if (!part.is_required) {
      inner += ", default: " + (part.fallback.empty() ? "none"
                                : part.has_default    ? "`" + part.fallback + "`"
                                                      : part.fallback);
    }
    inner += ")";
    const std::string said = meaning(vocabulary, part, told, true);
    if (!said.empty()) inner += " " + said;
  }
  if (is_inner) return text + (text.empty() ? "[" : " [") + inner + "]";
  return text + (text.empty() ? "" : ". ") + inner;
}

std::string defaultText(const MapWords& map, const KeyWords& key) {
  if (key.is_required) return "required";
  if (std::find(map.one_of.begin(), map.one_of.end(), key.name) != map.one_of.end()) {
    return "one of " + quotedList(map.one_of);
  }
  if (key.fallback.empty()) return "none";
  return key.has_default ? "`" + key.fallback + "`" : key.fallback;
}

/// The table of the kinds of fields, with the functions that make them.
std::string tableInCode(const Vocabulary& vocabulary) {
  std::string text = "| field | in C++ | in a scene file | metric |\n|---|---|---|---|\n";
  for (const KeyWords& kind : vocabulary.find("field_kind")->keys) {
    if (kind.metric == "grid") continue;
    text += "| " + kind.help + " | `" + kind.in_code + "` | `" + kind.name +
            "`: " + valueText(vocabulary, kind) + " | " + kind.metric + " |\n";
  }
  return text;
}

}  // namespace

std::string valueText(const Vocabulary& vocabulary, const KeyWords& key) {
  std::string text = oneText(vocabulary, key);
  if (key.varies) text += ", or a map";
  if (key.count == Count::kNames) return "map of names";
  if (key.count == Count::kOne) return text;
  if (key.at_least == key.at_most) return "list of " + std::to_string(key.at_least) + ": " + text;
  return "list" + (key.at_most > 0 ? ", at most " + std::to_string(key.at_most) + "," : "") +
         " of: " + text;
}

std::string keyTable(const Vocabulary& vocabulary, std::string_view name) {
  if (name == "in_code") return tableInCode(vocabulary);
  const MapWords* map = vocabulary.find(name);
  if (map == nullptr)
    throw Error(ErrorKind::kUsage,
                {"usage.command_line", "there is no map '" + std::string(name) + "'",
                 "palpate help scene lists them"});
  const bool are_kinds = name == "field_kind";
  std::string text = are_kinds ? "| kind | value | values | inside |\n|---|---|---|---|\n"
                               : "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const KeyWords& key : map->keys) {
    std::set<std::string> told;
    std::string row = "| `" + key.name + "` | " + valueText(vocabulary, key) + " | " +
                      (are_kinds ? key.metric : defaultText(*map, key)) + " | " +
                      meaning(vocabulary, key, told);
    // A bar would end the table cell.
    for (std::size_t at = 2; (at = row.find("|N|", at)) != std::string::npos; at += 5) {
      row.replace(at, 3, "\\|N\\|");
    }
    text += row + " |\n";
  }
  return text;
}

}  // namespace palpate::tools
