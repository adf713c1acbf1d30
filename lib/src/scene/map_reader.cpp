#include <algorithm>

#include "scene/messages.h"
#include "scene/values.h"

namespace palpate {

MapReader::MapReader(const SceneLoader& loader, const Node& map, std::string what)
    : loader_(&loader), map_(&map), what_(std::move(what)) {
  requireMap(loader.document(), map, what_);
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
  // A slip in the key is the likelier reason, and tells more.
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

double MapReader::lengthOr(std::string_view key, double fallback_metres) {
  const Node* node = optional(key);
  return node == nullptr ? fallback_metres : readLength(*loader_, *node, inQuotes(key));
}

Vec3 MapReader::requirePoint(std::string_view key) {
  const auto& items = readList(loader_->document(), require(key), inQuotes(key), 3, 3);
  const std::string what = "a coordinate of " + inQuotes(key);
  return {readLength(*loader_, items[0], what), readLength(*loader_, items[1], what),
          readLength(*loader_, items[2], what)};
}

Vec3 MapReader::requireDirection(std::string_view key) {
  const Document& document = loader_->document();
  const Node& node = require(key);
  const auto& items = readList(document, node, inQuotes(key), 3, 3);
  const std::string what = "a component of " + inQuotes(key);
  const Vec3 direction(readNumber(document, items[0], what), readNumber(document, items[1], what),
                       readNumber(document, items[2], what));
  if (direction == Vec3(0.0)) {
    throw document.error(node.mark, "scene.range", inQuotes(key) + " has no direction",
                         "one of its numbers must differ from 0");
  }
  return direction;
}

double MapReader::quantityOr(std::string_view key, Dimension dimension, double fallback) {
  const Node* node = optional(key);
  return node == nullptr ? fallback
                         : readQuantity(loader_->document(), *node, dimension, inQuotes(key));
}

}  // namespace palpate
