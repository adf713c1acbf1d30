#include "palpate/scene/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "own_vocabulary.h"
#include "palpate/core/text.h"
#include "scene/messages.h"
#include "scene/values.h"

namespace palpate {
namespace {

using Form = KeyWords::Form;
using Count = KeyWords::Count;

struct Type {
  std::string_view name;
  Form form;
  std::optional<Dimension> dimension = {};
  bool is_above = false;
  std::optional<double> least = {};
};

constexpr Type kTypes[] = {
    {"text", Form::kText},
    {"number", Form::kNumber},
    {"whole", Form::kWhole},
    {"boolean", Form::kBoolean},
    {"length_unit", Form::kLengthUnit},
    {"length", Form::kQuantity, Dimension::kLength},
    {"point", Form::kPoint, Dimension::kLength},
    {"size", Form::kPoint, Dimension::kLength, true, 0.0},
    {"direction", Form::kDirection},
    {"force", Form::kQuantity, Dimension::kForce, false, 0.0},
    {"stiffness", Form::kQuantity, Dimension::kStiffness, false, 0.0},
    {"damping", Form::kQuantity, Dimension::kDamping, false, 0.0},
    {"velocity", Form::kQuantity, Dimension::kVelocity},
    {"time", Form::kQuantity, Dimension::kTime, false, 0.0},
    {"stiffness_per_length", Form::kQuantity, Dimension::kStiffness2, false, 0.0},
    {"damping_per_length", Form::kQuantity, Dimension::kDamping2, false, 0.0},
    {"mass", Form::kQuantity, Dimension::kMass, false, 0.0},
    {"force_rate", Form::kQuantity, Dimension::kForceRate, false, 0.0},
    {"field", Form::kField},
    {"any", Form::kAny},
};

constexpr std::pair<std::string_view, std::string KeyWords::*> kTexts[] = {
    {"default", &KeyWords::fallback},
    {"unit", &KeyWords::unit},
    {"help", &KeyWords::help},
    {"more", &KeyWords::more},
    {"remedy", &KeyWords::remedy},
    {"needs", &KeyWords::needs},
    {"metric", &KeyWords::metric},
    {"in_code", &KeyWords::in_code},
    {"value", &KeyWords::value},
    {"called", &KeyWords::called},
    {"refused_as", &KeyWords::refused_as},
    {"since", &KeyWords::since},
};

std::vector<std::string> words(const Document& document, const Node& list) {
  std::vector<std::string> all;
  for (const Node& item : readList(document, list, "a list of words", 1, 0)) {
    all.push_back(item.text);
  }
  return all;
}

/// True if the default is a value of the key's type, which the reader then uses where the key is
/// absent.
bool isValue(const KeyWords& key, const Node& node) {
  if (node.quoted || key.count != Count::kOne) return false;
  switch (key.form) {
    case Form::kNumber:
    case Form::kWhole:
      return parseNumber(node.text).has_value();
    case Form::kQuantity:
      return parseQuantity(node.text, *key.dimension).status == Quantity::Status::kOk;
    case Form::kBoolean:
      return node.text == "true" || node.text == "false";
    case Form::kChoice:
      return std::find(key.choices.begin(), key.choices.end(), node.text) != key.choices.end();
    case Form::kText:
      return node.text.find(' ') == std::string::npos;
    default:
      return false;
  }
}

template <typename Items>
auto* named(Items& items, std::string_view name) noexcept {
  const auto at =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return at == items.end() ? nullptr : &*at;
}

/// The number as the declarations write it.
std::string shown(double value) { return shortNumber(value, 6); }

}  // namespace

std::string boundsText(const KeyWords& key) {
  const std::string whole = key.form == Form::kWhole ? "a whole number " : "";
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  const bool has_least = std::isfinite(key.least);
  if (key.never) return "not " + shown(*key.never);
  if (std::isfinite(key.most)) {
    const std::string most = shown(key.most) + unit;
    if (!has_least) return "at most " + most;
    return key.is_above ? "more than " + shown(key.least) + " and at most " + most
                        : whole + "from " + shown(key.least) + " to " + most;
  }
  if (!has_least) return {};
  if (key.is_above) return "more than " + shown(key.least) + unit;
  return whole.empty() ? shown(key.least) + unit + " or more" : whole + "from " + shown(key.least);
}

const KeyWords* MapWords::find(std::string_view key) const noexcept { return named(keys, key); }

const MapWords* Vocabulary::find(std::string_view map) const noexcept { return named(maps_, map); }

MapWords& Vocabulary::mapCalled(const std::string& name) {
  if (MapWords* map = named(maps_, name)) return *map;
  return maps_.emplace_back(MapWords{name});
}

void Vocabulary::readType(const Document& document, const Node& type, KeyWords& key) const {
  if (type.kind == Node::Kind::kSequence) {
    key.form = Form::kChoice;
    key.choices = words(document, type);
    return;
  }
  key.type = type.text;
  const auto* const plain = std::find_if(std::begin(kTypes), std::end(kTypes),
                                         [&](const Type& t) { return t.name == type.text; });
  if (plain != std::end(kTypes)) {
    key.form = plain->form;
    key.dimension = plain->dimension;
    key.least = plain->least.value_or(key.least);
    key.is_above = plain->is_above;
  } else if (const KeyWords* value = named(values_, type.text)) {
    const std::string name = std::exchange(key.name, {});
    key = *value;
    key.name = name;
    key.like = type.text;
  } else if (find(type.text) != nullptr) {
    key.form = Form::kMap;
  } else {
    throw document.error(type.mark, "vocabulary.type", "there is no type " + inQuotes(type.text));
  }
}

KeyWords Vocabulary::read(const Document& document, const Node::Entry& entry) const {
  KeyWords key;
  key.name = entry.key;
  const Node& map = entry.value;
  for (const auto& [word, count] :
       {std::pair{"is", Count::kOne}, {"list", Count::kList}, {"names", Count::kNames}}) {
    const Node* type = map.find(word);
    if (type == nullptr) continue;
    readType(document, *type, key);
    key.count = count;
  }
  for (const Node::Entry& said : map.entries) {
    const auto number = [&] { return readNumber(document, said.value, inQuotes(said.key)); };
    const auto* const text = std::find_if(std::begin(kTexts), std::end(kTexts),
                                          [&](const auto& t) { return t.first == said.key; });
    if (text != std::end(kTexts)) {
      key.*text->second = said.value.text;
      if (said.key == "default") key.has_default = isValue(key, said.value);
    } else if (said.key == "from" || said.key == "above") {
      key.least = number();
      key.is_above = said.key == "above";
    } else if (said.key == "to") {
      key.most = number();
    } else if (said.key == "never") {
      key.never = number();
    } else if (said.key == "at_least" || said.key == "at_most") {
      (said.key == "at_least" ? key.at_least : key.at_most) = static_cast<std::size_t>(number());
    } else if (said.key == "varies" || said.key == "required") {
      (said.key == "varies" ? key.varies : key.is_required) =
          readBool(document, said.value, inQuotes(said.key));
    } else if (said.key == "excludes" || said.key == "refuses") {
      (said.key == "excludes" ? key.excludes : key.refuses) = words(document, said.value);
    } else if (said.key == "schema") {
      key.schema = said.value;
    } else if (said.key != "is" && said.key != "list" && said.key != "names") {
      throw document.error(said.key_mark, "vocabulary.word", "unknown word " + inQuotes(said.key));
    }
  }
  return key;
}

void Vocabulary::add(std::string_view text, const std::string& file) {
  const auto document = parseDocument(text, file);
  const std::vector<Node::Entry>& entries = document->root.entries;
  // Maps may name each other in any order.
  for (const Node::Entry& entry : entries) {
    if (entry.value.find("is") == nullptr) (void)mapCalled(entry.key);
  }
  for (const Node::Entry& entry : entries) {
    if (entry.value.find("is") != nullptr) values_.push_back(read(*document, entry));
  }
  for (const Node::Entry& entry : entries) {
    if (entry.value.find("is") != nullptr) continue;
    MapWords& map = mapCalled(entry.key);
    for (const auto& [word, into] : {std::pair{"called", &MapWords::called},
                                     {"help", &MapWords::help},
                                     {"more", &MapWords::more}}) {
      if (const Node* said = entry.value.find(word)) map.*into = said->text;
    }
    for (const auto& [word, into] :
         {std::pair{"one_of", &MapWords::one_of}, {"any_of", &MapWords::any_of}}) {
      const Node* said = entry.value.find(word);
      if (said == nullptr) continue;
      const std::vector<std::string> more = words(*document, *said);
      (map.*into).insert((map.*into).end(), more.begin(), more.end());
    }
    const Node* keys = entry.value.find("keys");
    if (keys == nullptr) continue;
    for (const Node::Entry& said : keys->entries) {
      KeyWords key = read(*document, said);
      if (KeyWords* known = named(map.keys, key.name)) {
        *known = std::move(key);
      } else {
        map.keys.push_back(std::move(key));
      }
    }
  }
}

const VocabularyPtr& sceneVocabulary() {
  static const VocabularyPtr vocabulary = [] {
    auto own = std::make_shared<Vocabulary>();
    own->add(kOwnVocabulary, "vocabulary.yaml");
    return own;
  }();
  return vocabulary;
}

}  // namespace palpate
