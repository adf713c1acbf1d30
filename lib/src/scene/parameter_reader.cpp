#include "scene/parameter_reader.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "scene/messages.h"
#include "scene/unit_table.h"
#include "scene/values.h"

namespace palpate {
namespace {

std::string inUnit(double value, std::optional<Dimension> dimension) {
  char text[48];
  std::snprintf(text, sizeof text, "%.4g", value);
  return dimension ? text + (' ' + std::string(unitNames(*dimension)[0])) : text;
}

double readConstant(const SceneLoader& loader, const Node& node, const std::string& what,
                    std::optional<Dimension> dimension) {
  if (!dimension) return readNumber(loader.document(), node, what);
  if (*dimension == Dimension::kLength) return readLength(loader, node, what);
  return readQuantity(loader.document(), node, *dimension, what);
}

}  // namespace

Parameter readParameter(MapReader& reader, std::string_view key, std::optional<Dimension> dimension,
                        Parameter fallback) {
  const Node* node = reader.optional(key);
  if (node == nullptr) return fallback;
  const SceneLoader& loader = reader.loader();
  const std::string what = inQuotes(key);
  if (node->kind != Node::Kind::kMap) {
    const double value = readConstant(loader, *node, what, dimension);
    if (value < 0.0) throw reader.errorAt(key, "scene.range", what + " must be 0 or more");
    return value;
  }
  Parameter map(loader.map(*node, {std::string(key), dimension}));
  const MaterialMap::Range range = map.range();
  if (!(range.least >= 0.0) || !std::isfinite(range.most)) {
    throw reader.errorAt(key, "scene.range",
                         what + " goes from " + inUnit(range.least, dimension) + " to " +
                             inUnit(range.most, dimension) + ", and must be 0 or more everywhere",
                         "mend the values that the map is made from");
  }
  return map;
}

Parameter readVelocity(const SceneLoader& loader, const Node& node, const std::string& key) {
  const std::string what = "a component of " + inQuotes(key);
  if (node.kind != Node::Kind::kMap) {
    return readQuantity(loader.document(), node, Dimension::kVelocity, what);
  }
  Parameter map(loader.map(node, {key, Dimension::kVelocity, true}));
  const MaterialMap::Range range = map.range();
  if (!std::isfinite(range.least) || !std::isfinite(range.most)) {
    throw loader.document().error(node.mark, "scene.range", what + " is not finite everywhere",
                                  "mend the values that the map is made from");
  }
  return map;
}

Parameter requireParameter(MapReader& reader, std::string_view key,
                           std::optional<Dimension> dimension) {
  (void)reader.require(key);
  return readParameter(reader, key, dimension, {});
}

}  // namespace palpate
