#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "vocabulary/documents.h"

namespace palpate::tools {
namespace {

using Json = nlohmann::ordered_json;
using Form = KeyWords::Form;
using Count = KeyWords::Count;

Json reference(const std::string& name) { return {{"$ref", "#/definitions/" + name}}; }

/// The part of a vocabulary that is written in JSON Schema itself.
Json verbatim(const Node& node) {
  Json json;
  switch (node.kind) {
    case Node::Kind::kNull:
      return json;
    case Node::Kind::kSequence:
      json = Json::array();
      for (const Node& item : node.items) json.push_back(verbatim(item));
      return json;
    case Node::Kind::kMap:
      for (const Node::Entry& entry : node.entries) json[entry.key] = verbatim(entry.value);
      return json;
    case Node::Kind::kScalar:
      break;
  }
  const auto number = node.quoted ? std::nullopt : parseNumber(node.text);
  if (!number) return node.text;
  return *number == std::floor(*number) ? Json(static_cast<int>(*number)) : Json(*number);
}

/// The units of unitHelp(), such as "N/m (also N/mm, N/cm)", as alternatives of a regular
/// expression.
std::string unitPattern(Dimension dimension) {
  std::string pattern;
  std::string help(unitHelp(dimension));
  for (const std::string_view part : {" (also ", ", "}) {
    for (std::size_t at = 0; (at = help.find(part)) != std::string::npos;) {
      help.replace(at, part.size(), "|");
    }
  }
  help.pop_back();
  for (const char c : help) pattern += c == '.' || c == '^' ? std::string{'\\', c} : std::string{c};
  return pattern;
}

Json quantity(Dimension dimension, bool is_signed) {
  return {
      {"type", "string"},
      {"pattern", (is_signed ? "^[+-]?" : "^\\+?") +
                      std::string("((0|[1-9][0-9]*)(\\.[0-9]*)?|\\.[0-9]+)([eE][+-]?[0-9]+)? *(") +
                      unitPattern(dimension) + ")$"}};
}

Json listOf(Json items, std::size_t least, std::size_t most) {
  Json json = {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
  if (most > 0) json["maxItems"] = most;
  return json;
}

/// Values that keys refer to.
void addValues(const Vocabulary& vocabulary, Json& definitions) {
  definitions["length"] = {
      {"description", "A number in the scene's length unit, or a text with its own unit."},
      {"anyOf", Json::array({Json{{"type", "number"}}, quantity(Dimension::kLength, true)})}};
  definitions["positive_length"] = {
      {"description", "A length of more than 0."},
      {"anyOf", Json::array({Json{{"type", "number"}, {"exclusiveMinimum", 0}},
                             quantity(Dimension::kLength, false)})}};
  definitions["point"] = listOf(reference("length"), 3, 3);
  definitions["size"] = listOf(reference("positive_length"), 3, 3);
  definitions["direction"] = listOf({{"type", "number"}}, 3, 3);
  for (const auto& [name, dimension] : {std::pair{"force", Dimension::kForce},
                                        {"stiffness", Dimension::kStiffness},
                                        {"damping", Dimension::kDamping},
                                        {"velocity", Dimension::kVelocity},
                                        {"time", Dimension::kTime},
                                        {"stiffness_per_length", Dimension::kStiffness2},
                                        {"damping_per_length", Dimension::kDamping2},
                                        {"mass", Dimension::kMass},
                                        {"force_rate", Dimension::kForceRate}}) {
    definitions[name] = quantity(dimension, dimension == Dimension::kVelocity);
  }
  for (const KeyWords& value : vocabulary.values()) {
    if (value.schema.kind != Node::Kind::kNull) definitions[value.name] = verbatim(value.schema);
  }
  definitions["field"] = {
      {"description", "The name of a field of `fields`, or an inline field of one kind."},
      {"anyOf",
       Json::array({Json{{"type", "string"}, {"minLength", 1}}, reference("field_kind")})}};
  Json maps = Json::array();
  for (const MapWords& map : vocabulary.maps()) {
    if (map.name.starts_with("map_of_")) maps.push_back(reference(map.name));
  }
  definitions["parameter_map"] = {
      {"description", "A parameter that differs from place to place: asked for at the proxy."},
      {"anyOf", std::move(maps)}};
}

Json number(const KeyWords& key) {
  Json json = {{"type", key.form == Form::kWhole ? "integer" : "number"}};
  const auto shown = [](double value) {
    return value == std::floor(value) ? Json(static_cast<int>(value)) : Json(value);
  };
  if (std::isfinite(key.least))
    json[key.is_above ? "exclusiveMinimum" : "minimum"] = shown(key.least);
  if (std::isfinite(key.most)) json["maximum"] = shown(key.most);
  if (key.never) json["not"] = {{"const", shown(*key.never)}};
  return json;
}

/// The schema of a value at `key`, or of an item in its list.
Json one(const KeyWords& key) {
  if (key.schema.kind != Node::Kind::kNull) {
    return key.like.empty() ? verbatim(key.schema) : reference(key.like);
  }
  switch (key.form) {
    case Form::kText:
      return {{"type", "string"}, {"minLength", 1}};
    case Form::kNumber:
    case Form::kWhole:
      return number(key);
    case Form::kBoolean:
      return {{"type", "boolean"}};
    case Form::kChoice:
      return {{"enum", key.choices}};
    case Form::kLengthUnit:
      return {{"enum", {"m", "mm", "cm", "um", "in"}}};
    case Form::kQuantity:
      return reference(key.type == "length" && key.is_above ? "positive_length" : key.type);
    case Form::kPoint:
    case Form::kDirection:
    case Form::kField:
    case Form::kMap:
      return reference(key.type);
    case Form::kAny:
      return Json::object();
  }
  return {};
}

Json refusing(Json json, const KeyWords& key) {
  if (key.refuses.empty()) return json;
  const Json refused = {{"not", {{"enum", key.refuses}}}};
  return {{"allOf", Json::array({std::move(json), refused})}};
}

Json keySchema(const KeyWords& key) {
  Json json = one(key);
  if (key.varies) json = {{"anyOf", Json::array({std::move(json), reference("parameter_map")})}};
  if (key.count == Count::kList) json = listOf(std::move(json), key.at_least, key.at_most);
  if (key.count == Count::kNames) {
    json = {{"type", "object"}, {"additionalProperties", std::move(json)}};
    if (!key.refuses.empty()) json["propertyNames"] = {{"not", {{"enum", key.refuses}}}};
  } else {
    json = refusing(std::move(json), key);
  }
  std::string said = key.help;
  if (!key.fallback.empty()) said += (said.empty() ? "" : "; ") + key.fallback + " if not given";
  if (said.empty()) return json;
  // In draft 7, keywords beside a reference are ignored.
  if (json.contains("$ref")) json = {{"allOf", Json::array({std::move(json)})}};
  json["description"] = said + ".";
  return json;
}

Json required(const std::vector<std::string>& keys) {
  Json all = Json::array();
  for (const std::string& key : keys) all.push_back({{"required", {key}}});
  return all;
}

Json mapSchema(const MapWords& map) {
  Json json = {{"type", "object"}};
  if (!map.help.empty()) json["description"] = map.help;
  json["additionalProperties"] = false;
  Json properties = Json::object();
  for (const KeyWords& key : map.keys) {
    if (key.is_required) json["required"].push_back(key.name);
    properties[key.name] = keySchema(key);
    if (!key.excludes.empty()) {
      json["dependencies"][key.name] = {{"not", {{"anyOf", required(key.excludes)}}}};
    }
  }
  json["properties"] = std::move(properties);
  if (!map.one_of.empty()) json["oneOf"] = required(map.one_of);
  if (!map.any_of.empty()) json["anyOf"] = required(map.any_of);
  if (map.name == "field_kind") {
    json["minProperties"] = 1;
    json["maxProperties"] = 1;
  }
  return json;
}

}  // namespace

std::string schemaText(const Vocabulary& vocabulary) {
  Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"},
               {"title", "Palpate scene, format 1"}};
  json.update(mapSchema(*vocabulary.find("scene")));
  Json definitions = Json::object();
  addValues(vocabulary, definitions);
  for (const MapWords& map : vocabulary.maps()) {
    if (map.name != "scene") definitions[map.name] = mapSchema(map);
  }
  json["definitions"] = std::move(definitions);
  return json.dump(2) + "\n";
}

}  // namespace palpate::tools
