#include <algorithm>

#include "scene/messages.h"
#include "scene/values.h"

namespace palpate {

MapReader::MapReader(const SceneLoader& loader, const Node& map, std::string what)
    : loader_(&loader), map_(&map), what_(std::move(what)) {
  requireMap(loader.document(), map, what_);
}

MapReader::MapReader(const SceneLoader& loader, const Node& map, std::string what,
                     std::string_view declared)
    : MapReader(loader, map, std::move(what)) {
  const MapWords* words = loader.vocabulary().find(declared);
  if (words == nullptr || words->keys.empty()) return;
  words_ = words;
  for (const KeyWords& key : words->keys) known_.push_back(key.name);
  for (const KeyWords& key : words->keys) {
    const Node* value = key.is_required ? &require(key.name) : optional(key.name);
    if (value != nullptr) checkValue(loader, *value, key);
  }
  finish();
}

const KeyWords& MapReader::words(std::string_view key) const {
  const KeyWords* words = words_ == nullptr ? nullptr : words_->find(key);
  if (words != nullptr) return *words;
  throw Error(ErrorKind::kOperation, {"scene.undeclared", what_ + " declares no " + inQuotes(key)});
}

double MapReader::value(std::string_view key) const {
  const KeyWords& words = this->words(key);
  if (const Node* node = find(key)) return readValue(*loader_, *node, words);
  if (!words.has_default) return 0.0;
  return words.form == KeyWords::Form::kQuantity
             ? parseQuantity(words.fallback, *words.dimension).si
             : *parseNumber(words.fallback);
}

std::string MapReader::text(std::string_view key) const {
  const KeyWords& words = this->words(key);
  const Node* node = find(key);
  return node != nullptr ? node->text : words.has_default ? words.fallback : std::string();
}

int MapReader::choice(std::string_view key) const {
  const std::vector<std::string>& choices = words(key).choices;
  const auto at = std::find(choices.begin(), choices.end(), text(key));
  return at == choices.end() ? -1 : static_cast<int>(at - choices.begin());
}

bool MapReader::flag(std::string_view key) const { return text(key) == "true"; }

Vec3 MapReader::point(std::string_view key) const {
  const KeyWords& words = this->words(key);
  const Node* node = find(key);
  return node == nullptr ? Vec3(0.0) : readVector(*loader_, *node, words);
}

MapReader MapReader::map(std::string_view key) const {
  const KeyWords& words = this->words(key);
  return {*loader_, *find(key), words.called.empty() ? inQuotes(key) : words.called, words.type};
}

std::vector<MapReader> MapReader::maps(std::string_view key) const {
  const KeyWords& declared = words(key);
  const std::string& type = declared.type;
  std::vector<MapReader> all;
  for (const Node& item : readList(loader_->document(), *find(key), inQuotes(declared.name),
                                   declared.at_least, declared.at_most)) {
    all.emplace_back(*loader_, item, loader_->vocabulary().find(type)->called, type);
  }
  return all;
}

bool MapReader::has(std::string_view key) const noexcept { return map_->find(key) != nullptr; }

const Node* MapReader::optional(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  for (const Node::Entry& entry : map_->entries) {
    if (entry.key != key) continue;
    refuseEmpty(loader_->document(), entry);
    return &entry.value;
  }
  return nullptr;
}

const Node& MapReader::require(std::string_view key) {
  if (const Node* node = optional(key)) return *node;
  // A misspelled key is more likely than a missing one, and its message is more helpful.
  for (const Node::Entry& entry : map_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    if (entry.key.starts_with(std::string(key) + ':')) throw unknown(entry, {});
    if (!suggest(entry.key, std::vector{key}).empty()) {
      throw unknown(entry, {key});
    }
  }
  throw loader_->document().error(map_->mark, "scene.missing_key",
                                  what_ + " has no " + inQuotes(key),
                                  "add " + std::string(key) + ": ...");
}

void MapReader::finish() {
  for (const Node::Entry& entry : map_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    throw unknown(entry, {known_.begin(), known_.end()});
  }
}

Error MapReader::unknown(const Node::Entry& entry,
                         const std::vector<std::string_view>& names) const {
  // YAML reads {region:skin} as one key without a value.
  const bool glued =
      entry.value.kind == Node::Kind::kNull && entry.key.find(':') != std::string::npos;
  return loader_->document().error(
      entry.key_mark, "scene.unknown_key", "unknown key " + inQuotes(entry.key) + " in " + what_,
      glued ? "put a space behind the ':'" : suggestOrList(entry.key, names, "keys here: "));
}

Error MapReader::errorAt(std::string_view key, std::string code, std::string message,
                         std::string hint) const {
  const Node* node = map_->find(key);
  return loader_->document().error(node == nullptr ? map_->mark : node->mark, std::move(code),
                                   std::move(message), std::move(hint));
}

std::string MapReader::requireText(std::string_view key) {
  return readText(loader_->document(), require(key), inQuotes(key));
}

std::string MapReader::textOr(std::string_view key, std::string fallback) {
  const Node* node = optional(key);
  return node == nullptr ? std::move(fallback)
                         : readText(loader_->document(), *node, inQuotes(key));
}

double MapReader::requireNumber(std::string_view key) {
  return readNumber(loader_->document(), require(key), inQuotes(key));
}

double MapReader::numberOr(std::string_view key, double fallback) {
  const Node* node = optional(key);
  return node == nullptr ? fallback : readNumber(loader_->document(), *node, inQuotes(key));
}

bool MapReader::boolOr(std::string_view key, bool fallback) {
  const Node* node = optional(key);
  return node == nullptr ? fallback : readBool(loader_->document(), *node, inQuotes(key));
}

double MapReader::requireLength(std::string_view key) {
  return readLength(*loader_, require(key), inQuotes(key));
}

Vec3 MapReader::requirePoint(std::string_view key) {
  KeyWords point{std::string(key)};
  point.form = KeyWords::Form::kPoint;
  return readVector(*loader_, require(key), point);
}

double MapReader::lengthOr(std::string_view key, double fallback_meters) {
  const Node* node = optional(key);
  return node == nullptr ? fallback_meters : readLength(*loader_, *node, inQuotes(key));
}

}  // namespace palpate
