#include "scene/parameter_reader.h"

#include <cmath>
#include <string>
#include <utility>

#include "palpate/core/text.h"
#include "scene/messages.h"
#include "scene/unit_table.h"
#include "scene/values.h"

namespace palpate {
namespace {

std::string inUnit(double value, std::optional<Dimension> dimension) {
  const std::string number = shortNumber(value, 4);
  return dimension ? number + ' ' + std::string(unitNames(*dimension)[0]) : number;
}

/// Reads a map, whose range must be finite and within the key's bounds.
Parameter readMap(const SceneLoader& loader, const Node& node, const KeyWords& key) {
  const std::string what = inQuotes(key.name);
  const bool is_signed = key.least < 0.0;
  Parameter map(loader.map(node, {key.name, key.dimension, is_signed}));
  const MaterialMap::Range range = map.range();
  const auto refuse = [&](const std::string& message, const char* hint) {
    return loader.document().error(node.mark, "scene.range", message, hint);
  };
  constexpr const char* kMend = "correct the values from which the map is made";
  if (is_signed && !(std::isfinite(range.least) && std::isfinite(range.most))) {
    throw refuse("a component of " + what + " is not finite everywhere", kMend);
  }
  if (!is_signed && !(range.least >= 0.0 && std::isfinite(range.most))) {
    throw refuse(what + " goes from " + inUnit(range.least, key.dimension) + " to " +
                     inUnit(range.most, key.dimension) + ", and must be 0 or more everywhere",
                 kMend);
  }
  if (key.is_above && !(range.most > key.least)) {
    throw refuse(what + " must be " + boundsText(key), "");
  }
  return map;
}

Parameter readOne(const SceneLoader& loader, const Node& node, const KeyWords& key) {
  return node.kind == Node::Kind::kMap ? readMap(loader, node, key)
                                       : Parameter(readValue(loader, node, key));
}

}  // namespace

Parameter readParameter(const MapReader& reader, std::string_view key) {
  return readParameter(reader, key, reader.has(key) ? 0.0 : reader.value(key));
}

Parameter readParameter(const MapReader& reader, std::string_view key, Parameter fallback) {
  const Node* node = reader.find(key);
  return node == nullptr ? fallback : readOne(reader.loader(), *node, reader.words(key));
}

Flow readFlow(const MapReader& reader, std::string_view key) {
  const Node* node = reader.find(key);
  if (node == nullptr) return {};
  const auto component = [&](std::size_t i) {
    return readOne(reader.loader(), node->items[i], reader.words(key));
  };
  return {component(0), component(1), component(2)};
}

}  // namespace palpate
