#include <algorithm>
#include <set>

#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/scene/suggestion.h"
#include "vocabulary/documents.h"

namespace palpate::tools {
namespace {

std::string withoutBackticks(std::string text) {
  std::erase(text, '`');
  return text;
}

std::string lineOf(const Vocabulary& vocabulary, const KeyWords& key) {
  std::string text = "  " + key.name;
  text.resize(std::max<std::size_t>(text.size() + 1, 18), ' ');
  text += withoutBackticks(valueText(vocabulary, key));
  if (key.is_required) text += "; required";
  if (!key.fallback.empty()) text += "; default: " + withoutBackticks(key.fallback);
  return text + "\n" +
         (key.help.empty() ? "" : std::string(18, ' ') + withoutBackticks(key.help) + "\n");
}

std::string helpOfMap(const Vocabulary& vocabulary, const MapWords& map) {
  std::string text = map.name + "\n";
  if (!map.help.empty()) text += "  " + withoutBackticks(map.help) + "\n";
  for (const auto& [lead, keys] :
       {std::pair{"  One of: ", &map.one_of}, {"  At least one of: ", &map.any_of}}) {
    for (const std::string& key : *keys) text += (key == keys->front() ? lead : ", ") + key;
    if (!keys->empty()) text += "\n";
  }
  text += "\n";
  for (const KeyWords& key : map.keys) text += lineOf(vocabulary, key);
  return text;
}

std::string helpOfKey(const Vocabulary& vocabulary, const MapWords& map, const KeyWords& key) {
  std::string text = map.name + "." + key.name + "\n";
  const auto line = [&](const char* what, const std::string& said) {
    if (!said.empty()) text += std::string("  ") + what + withoutBackticks(said) + "\n";
  };
  line("", key.help + (key.more.empty() ? "" : ". " + key.more));
  line("value:    ", valueText(vocabulary, key));
  line("default:  ", key.is_required ? "none, it is required" : key.fallback);
  line("needs:    ", key.needs);
  line("not with: ", joined(key.excludes));
  line("values:   ", key.metric);
  line("in code:  ", key.in_code);
  line("since:    ", key.since);
  if (key.form == KeyWords::Form::kMap)
    text += "\n" + helpOfMap(vocabulary, *vocabulary.find(key.type));
  return text;
}

}  // namespace

std::vector<std::string> sceneWords(const Vocabulary& vocabulary) {
  std::set<std::string> words;
  for (const MapWords& map : vocabulary.maps()) {
    words.insert(map.name);
    for (const KeyWords& key : map.keys) words.insert(key.name);
  }
  return {words.begin(), words.end()};
}

std::string sceneHelp(const Vocabulary& vocabulary, const std::string& word) {
  std::string text;
  if (word.empty()) {
    for (const MapWords& map : vocabulary.maps()) {
      text += (text.empty() ? "" : "\n") + helpOfMap(vocabulary, map);
    }
    return text;
  }
  const std::size_t dot = word.find('.');
  const std::string name = dot == std::string::npos ? word : word.substr(dot + 1);
  for (const MapWords& map : vocabulary.maps()) {
    if (dot == std::string::npos && map.name == word) {
      text += (text.empty() ? "" : "\n") + helpOfMap(vocabulary, map);
    }
    if (dot != std::string::npos && map.name != word.substr(0, dot)) continue;
    const KeyWords* key = map.find(name);
    // The map that describes a kind of field also says which kind it is.
    if (key == nullptr ||
        (dot == std::string::npos && key->type == word && vocabulary.find(word))) {
      continue;
    }
    text += (text.empty() ? "" : "\n") + helpOfKey(vocabulary, map, *key);
  }
  if (!text.empty()) return text;
  throw Error(ErrorKind::kUsage,
              {"usage.command_line", "no key or map of a scene is called '" + word + "'",
               suggestionFor(name, sceneWords(vocabulary), "palpate help scene lists them")});
}

}  // namespace palpate::tools
