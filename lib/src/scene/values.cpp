#include "scene/values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palpate/scene/suggestion.h"
#include "scene/messages.h"
#include "scene/unit_table.h"

namespace palpate {
namespace {

std::string shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return "nothing";
    case Node::Kind::kSequence:
      return "a list";
    case Node::Kind::kMap:
      return "a map";
    case Node::Kind::kScalar:
      return inQuotes(node.text);
  }
  return "nothing";
}

Error wrongKind(const Document& document, const Node& node, const std::string& what,
                std::string_view wanted, std::string hint = {}) {
  return document.error(node.mark, node.kind == Node::Kind::kNull ? "scene.empty" : "scene.kind",
                        what + " must be " + std::string(wanted) + ", not " + shown(node),
                        std::move(hint));
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// What to write instead of a text that is not a number; empty if that is not known.
std::string numberHint(std::string_view text) {
  if (text.find("\xC2\xA0") != std::string_view::npos) {
    return "there is a no-break space in it; write a plain one";
  }
  std::string_view digits = text;
  const bool negative = !digits.empty() && digits[0] == '-';
  if (negative || (!digits.empty() && digits[0] == '+')) digits.remove_prefix(1);
  std::string lower(digits);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (lower == ".inf" || lower == "inf" || lower == "infinity" || lower == ".nan" ||
      lower == "nan") {
    return "write a finite number";
  }
  if (digits.size() > 1 && digits[0] == '0') {
    if (lower[1] == 'x' || lower[1] == 'o' || lower[1] == 'b') return "write a decimal number";
    const std::size_t first = digits.find_first_not_of('0');
    if (isDigit(digits[1]) && first != std::string_view::npos) {
      return "a leading zero means octal to some readers; write " +
             std::string(negative ? "-" : "") +
             std::string(digits.substr(isDigit(digits[first]) ? first : first - 1));
    }
  }
  if (!digits.empty() && isDigit(digits[0])) {
    if (digits.find(',') != std::string_view::npos) return "write a decimal point, not a comma";
    if (digits.find('_') != std::string_view::npos) return "write the digits without '_'";
  }
  return {};
}

Error notANumber(const Document& document, const Node& node, const std::string& what,
                 std::string_view wanted, std::string fallback_hint) {
  std::string hint = numberHint(node.text);
  if (hint.empty()) hint = std::move(fallback_hint);
  return document.error(node.mark, "scene.number",
                        what + " must be " + std::string(wanted) + ", not " + inQuotes(node.text),
                        std::move(hint));
}

Error badUnit(const Document& document, const Node& node, Dimension dimension,
              const Quantity& quantity, const std::string& what) {
  const std::string wanted(dimensionName(dimension));
  const std::string help(unitHelp(dimension));
  if (quantity.status == Quantity::Status::kMissingUnit) {
    return document.error(node.mark, "scene.unit", what + " is " + wanted + " and needs its unit",
                          "write " + node.text + " " + help);
  }
  if (quantity.status == Quantity::Status::kWrongDimension) {
    return document.error(
        node.mark, "scene.unit",
        what + " must be " + wanted + "; " + inQuotes(quantity.unit) + " is not a unit of it",
        "units: " + help);
  }
  return document.error(node.mark, "scene.unit",
                        what + " has the unknown unit " + inQuotes(quantity.unit),
                        suggestionFor(quantity.unit, unitNames(dimension), "units: " + help));
}

}  // namespace

std::string readText(const Document& document, const Node& node, const std::string& what) {
  if (node.kind != Node::Kind::kScalar) throw wrongKind(document, node, what, "a text");
  if (node.text.empty()) {
    throw document.error(node.mark, "scene.empty", what + " is an empty text");
  }
  const auto control = [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F;
  };
  if (std::any_of(node.text.begin(), node.text.end(), control)) {
    throw document.error(node.mark, "scene.kind", what + " has a control character in it");
  }
  if (!node.quoted && (parseNumber(node.text) || node.text == "true" || node.text == "false")) {
    throw document.error(node.mark, "scene.kind", what + " must be a text, not " + shown(node),
                         "quote it: \"" + node.text + "\"");
  }
  return node.text;
}

double readNumber(const Document& document, const Node& node, const std::string& what) {
  if (node.kind != Node::Kind::kScalar) throw wrongKind(document, node, what, "a number");
  const std::optional<double> number = parseNumber(node.text);
  if (node.quoted) {
    throw document.error(node.mark, "scene.kind", what + " must be a number, not a quoted text",
                         number ? "remove the quotes: " + node.text : std::string());
  }
  if (!number) {
    throw notANumber(document, node, what, "a number", "a plain decimal number without a unit");
  }
  return *number;
}

bool readBool(const Document& document, const Node& node, const std::string& what) {
  if (node.kind == Node::Kind::kScalar && !node.quoted) {
    if (node.text == "true") return true;
    if (node.text == "false") return false;
  }
  throw wrongKind(document, node, what, "true or false",
                  "only true and false are read; yes, no, on and off differ between YAML readers");
}

double readQuantity(const Document& document, const Node& node, Dimension dimension,
                    const std::string& what) {
  const std::string_view wanted = dimensionName(dimension);
  if (node.kind != Node::Kind::kScalar) throw wrongKind(document, node, what, wanted);
  const Quantity quantity = parseQuantity(node.text, dimension);
  if (quantity.status == Quantity::Status::kOk) return quantity.si;
  if (quantity.status == Quantity::Status::kNotANumber) {
    throw notANumber(document, node, what, wanted,
                     "a number and its unit: " + std::string(unitHelp(dimension)));
  }
  throw badUnit(document, node, dimension, quantity, what);
}

double readLength(const SceneLoader& loader, const Node& node, const std::string& what) {
  const Document& document = loader.document();
  if (node.kind != Node::Kind::kScalar) throw wrongKind(document, node, what, "a length");
  const std::optional<double> number = parseNumber(node.text);
  if (number && !node.quoted) return scaledTo(*number, loader.metersPerUnit());
  const Quantity quantity = parseQuantity(node.text, Dimension::kLength);
  if (quantity.status == Quantity::Status::kOk) return quantity.si;
  if (number) {
    throw document.error(node.mark, "scene.kind", what + " must be a length, not digits in quotes",
                         "remove the quotes: " + node.text + " (in " + loader.lengthUnit() +
                             "); or write the unit inside them");
  }
  if (quantity.status == Quantity::Status::kNotANumber) {
    throw notANumber(document, node, what, "a length",
                     "a number in " + loader.lengthUnit() +
                         ", or one with its unit: " + std::string(unitHelp(Dimension::kLength)));
  }
  throw badUnit(document, node, Dimension::kLength, quantity, what);
}

const std::vector<Node>& readList(const Document& document, const Node& node,
                                  const std::string& what, std::size_t least, std::size_t most) {
  if (node.kind != Node::Kind::kSequence) {
    std::string hint;
    if (node.kind == Node::Kind::kScalar && least <= 1) hint = "write [" + node.text + "]";
    throw wrongKind(document, node, what, "a list", std::move(hint));
  }
  if (node.items.size() < least || (most != 0 && node.items.size() > most)) {
    // A limit in the thousands only guards against abuse: do not mention it to a user who gave too
    // few.
    const bool is_open = most == 0 || (most >= 1000 && node.items.size() < least);
    const std::string wanted = least == most ? std::to_string(least)
                               : is_open     ? std::to_string(least) + " or more"
                                         : std::to_string(least) + " to " + std::to_string(most);
    throw document.error(
        node.mark, "scene.length",
        what + " must be a list of " + wanted + ", not of " + std::to_string(node.items.size()));
  }
  for (const Node& item : node.items) {
    if (item.kind == Node::Kind::kNull) {
      throw document.error(item.mark, "scene.empty", what + " has an empty entry here",
                           "fill it in or remove it");
    }
  }
  return node.items;
}

std::size_t readChoice(const Document& document, const Node& node, const std::string& what,
                       const std::vector<std::string_view>& choices) {
  if (node.kind != Node::Kind::kScalar) {
    throw wrongKind(document, node, what, "one of " + listed(choices));
  }
  const auto found = std::find(choices.begin(), choices.end(), node.text);
  if (found == choices.end()) {
    throw document.error(node.mark, "scene.choice",
                         what + " is " + listed(choices) + ", not " + inQuotes(node.text),
                         suggestOrList(node.text, choices, "one of "));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

Error unknownName(const Document& document, Mark mark, const std::string& kind,
                  const std::string& name, const std::vector<std::string_view>& names) {
  std::string hint = suggestOrList(name, names, kind + "s: ");
  if (hint.empty()) hint = "define it in `" + kind + "s`";
  return document.error(mark, "scene.unknown_" + kind, "there is no " + kind + " " + inQuotes(name),
                        std::move(hint));
}

Error noReader(const Document& document, Mark mark, const std::string& what) {
  return document.error(mark, "scene.no_reader", "this program cannot read " + what,
                        "palpate::vdb reads them, and is not part of this program");
}

void requireMap(const Document& document, const Node& node, const std::string& what) {
  if (node.kind != Node::Kind::kMap) throw wrongKind(document, node, what, "a map {key: value}");
}

void refuseEmpty(const Document& document, const Node::Entry& entry) {
  if (entry.value.kind == Node::Kind::kNull) {
    std::string hint = "give it a value or remove it";
    if (entry.key.find(':') != std::string::npos) hint = "put a space behind the ':'";
    throw document.error(entry.key_mark, "scene.empty", inQuotes(entry.key) + " has no value",
                         std::move(hint));
  }
}

Mat3 readRotation(const MapReader& rotate) {
  return rotationAbout(rotate.point("axis"), rotate.value("degrees") * std::numbers::pi / 180.0);
}

namespace {

void checkBounds(const Document& document, const Node& node, const KeyWords& key, double value) {
  const bool is_whole = key.form == KeyWords::Form::kWhole;
  const double most =
      is_whole ? std::min<double>(key.most, std::numeric_limits<int>::max()) : key.most;
  const bool is_within = (key.is_above ? value > key.least : value >= key.least) && value <= most &&
                         (!is_whole || value == std::floor(value)) && value != key.never;
  if (is_within) return;
  const std::string what = key.form == KeyWords::Form::kPoint ? "each length of " : "";
  throw document.error(
      node.mark, "scene.range",
      what + inQuotes(key.name) + " must " +
          (key.never ? "not be " + boundsText(key).substr(4) : "be " + boundsText(key)),
      key.remedy);
}

/// `units: parsec`
void checkUnit(const Document& document, const Node& node, const std::string& what) {
  const std::string unit = readText(document, node, what);
  if (metersPer(unit)) return;
  throw document.error(node.mark, "scene.unit", inQuotes(unit) + " is not a length unit",
                       "units: " + std::string(unitHelp(Dimension::kLength)));
}

void checkOne(const SceneLoader& loader, const Node& node, const KeyWords& key,
              const std::string& what) {
  const Document& document = loader.document();
  switch (key.form) {
    case KeyWords::Form::kText:
      (void)readText(document, node, what);
      return;
    case KeyWords::Form::kNumber:
    case KeyWords::Form::kWhole:
    case KeyWords::Form::kQuantity:
      (void)readValue(loader, node, key);
      return;
    case KeyWords::Form::kBoolean:
      (void)readBool(document, node, what);
      return;
    case KeyWords::Form::kChoice:
      (void)readChoice(document, node, key);
      return;
    case KeyWords::Form::kLengthUnit:
      checkUnit(document, node, what);
      return;
    case KeyWords::Form::kPoint:
    case KeyWords::Form::kDirection:
      (void)readVector(loader, node, key);
      return;
    case KeyWords::Form::kField:
    case KeyWords::Form::kMap:
    case KeyWords::Form::kAny:
      return;
  }
}

}  // namespace

double readValue(const SceneLoader& loader, const Node& node, const KeyWords& key) {
  const Document& document = loader.document();
  const std::string what =
      (key.count == KeyWords::Count::kList ? "a component of " : "") + inQuotes(key.name);
  const double value = key.form != KeyWords::Form::kQuantity ? readNumber(document, node, what)
                       : key.dimension == Dimension::kLength
                           ? readLength(loader, node, what)
                           : readQuantity(document, node, *key.dimension, what);
  checkBounds(document, node, key, value);
  return value;
}

Vec3 readVector(const SceneLoader& loader, const Node& node, const KeyWords& key) {
  const Document& document = loader.document();
  const bool is_direction = key.form == KeyWords::Form::kDirection;
  const auto& items = readList(document, node, inQuotes(key.name), 3, 3);
  const std::string what =
      (is_direction ? "a component of " : "a coordinate of ") + inQuotes(key.name);
  Vec3 vector;
  for (int i = 0; i < 3; ++i) {
    const Node& item = items[static_cast<std::size_t>(i)];
    vector[i] = is_direction ? readNumber(document, item, what) : readLength(loader, item, what);
  }
  if (!is_direction) {
    for (int i = 0; i < 3; ++i) checkBounds(document, node, key, vector[i]);
  } else if (vector == Vec3(0.0)) {
    throw document.error(node.mark, "scene.range", inQuotes(key.name) + " has no direction",
                         "one of its numbers must differ from 0");
  }
  return vector;
}

std::size_t readChoice(const Document& document, const Node& node, const KeyWords& key) {
  const std::vector<std::string_view> choices(key.choices.begin(), key.choices.end());
  const std::string what = inQuotes(key.name);
  if (key.refused_as.empty()) return readChoice(document, node, what, choices);
  const std::string word = readText(document, node, what);
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  std::string write = "write ";
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) write += i + 1 == choices.size() ? " or " : ", ";
    write += key.name + ": " + std::string(choices[i]);
  }
  throw document.error(node.mark, key.refused_as, what + " is `" + word + "`",
                       key.remedy.empty() ? write : key.remedy);
}

void checkValue(const SceneLoader& loader, const Node& node, const KeyWords& key) {
  const Document& document = loader.document();
  const std::string what = inQuotes(key.name);
  const auto is_map_of_places = [&](const Node& value) {
    return key.varies && value.kind == Node::Kind::kMap;
  };
  switch (key.count) {
    case KeyWords::Count::kNames:
      requireMap(document, node, what);
      return;
    case KeyWords::Count::kOne:
      if (!is_map_of_places(node)) checkOne(loader, node, key, what);
      return;
    case KeyWords::Count::kList:
      // The number of maps in a list is checked when they are opened, so that errors before them in
      // the file are reported first.
      for (const Node& item :
           readList(document, node, what, key.form == KeyWords::Form::kMap ? 0 : key.at_least,
                    key.form == KeyWords::Form::kMap ? 0 : key.at_most)) {
        if (!is_map_of_places(item)) checkOne(loader, item, key, "an item of " + what);
      }
      return;
  }
}

}  // namespace palpate
