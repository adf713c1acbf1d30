#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "import/own_tables.h"
#include "import/table_loader.h"
#include "import/tissue_table.h"
#include "palpate/scene/scene_file.h"
#include "text.h"

namespace palpate::tools {
namespace {

enum class NumberKind {
  kLength,
  kStiffness,
  kPressure,
  kRatio,
  kDamping,
  kForce,
  kForcePerLength,
  kStiffnessPerLength
};

std::optional<double> pressure(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits = {
      {{" GPa", 1e9}, {" MPa", 1e6}, {" kPa", 1e3}, {" Pa", 1.0}}};
  for (const auto& [unit, factor] : kUnits) {
    if (!text.ends_with(unit)) continue;
    const auto number = parseNumber(text.substr(0, text.size() - unit.size()));
    if (!number) return std::nullopt;
    return *number * factor;
  }
  return std::nullopt;
}

std::optional<double> valueOf(std::string_view text, NumberKind kind) {
  const auto with_unit = [&](Dimension dimension) -> std::optional<double> {
    const auto parsed = parseQuantity(text, dimension);
    if (parsed.status != Quantity::Status::kOk) return std::nullopt;
    return parsed.si;
  };
  switch (kind) {
    case NumberKind::kLength:
      return with_unit(Dimension::kLength);
    case NumberKind::kStiffness:
      return with_unit(Dimension::kStiffness);
    case NumberKind::kPressure:
      return pressure(text);
    case NumberKind::kRatio:
      return parseNumber(text);
    case NumberKind::kDamping:
      return with_unit(Dimension::kDamping);
    case NumberKind::kForce:
      return with_unit(Dimension::kForce);
    case NumberKind::kForcePerLength:
      return with_unit(Dimension::kStiffness);
    case NumberKind::kStiffnessPerLength:
      return with_unit(Dimension::kStiffness2);
  }
  return std::nullopt;
}

const char* unitsOf(NumberKind kind) {
  switch (kind) {
    case NumberKind::kLength:
      return "a length with its unit, more than 0: 1 mm";
    case NumberKind::kStiffness:
      return "a stiffness, more than 0: 400 N/m";
    case NumberKind::kPressure:
      return "a modulus, more than 0, in Pa, kPa, MPa or GPa: 62 kPa";
    case NumberKind::kRatio:
      return "a plain number, 0 or more: 0.45";
    case NumberKind::kDamping:
      return "a damping, 0 or more: 2 N.s/m";
    case NumberKind::kForce:
      return "a force, 0 or more: 2.8 N";
    case NumberKind::kForcePerLength:
      return "a friction per length, 0 or more: 40 N/m";
    case NumberKind::kStiffnessPerLength:
      return "a stiffness per length, more than 0: 3e4 N/m^2";
  }
  return "";
}

class TableReader {
 public:
  explicit TableReader(const Document& document) : loader_(document, "tissues") {}

  TissueTable read() {
    const Document& document = loader_.document();
    TissueTable table;
    table.file = document.file;
    MapReader root(loader_, document.root, "a table of tissues");
    if (root.requireNumber("palpate_tissues") != 1.0) {
      throw root.errorAt("palpate_tissues", "tissues.version",
                         "this is another version of tissue tables", "write palpate_tissues: 1");
    }
    table.tip_radius = number(root.require("tip_radius"), "tip_radius", NumberKind::kLength);
    table.stiffest = number(root.require("stiffest"), "stiffest", NumberKind::kStiffness);
    if (const Node* spring = root.optional("shaft_spring")) {
      table.shaft_spring = number(*spring, "shaft_spring", NumberKind::kStiffnessPerLength);
    }
    if (const Node* young = root.optional("shaft_young")) {
      table.shaft_young = number(*young, "shaft_young", NumberKind::kPressure);
    }
    has_spring_ = table.shaft_spring.has_value();
    table.unknown = root.textOr("unknown", "");
    const Node& tissues = root.require("tissues");
    if (tissues.kind != Node::Kind::kMap || tissues.entries.empty()) {
      throw document.error(tissues.mark, "tissues.kind", "'tissues' must be a map of tissues",
                           "write tissues: {muscle: {labels: [\"*muscle*\"], ...}}");
    }
    root.finish();
    for (const Node::Entry& entry : tissues.entries) {
      table.tissues.push_back(tissue(entry));
    }
    checkNames(table, tissues);
    return table;
  }

 private:
  SourcedNumber number(const Node& node, const std::string& what, NumberKind kind) {
    const Document& document = loader_.document();
    MapReader reader(loader_, node, what);
    const Node& value = reader.require("value");
    const std::optional<double> parsed =
        value.kind == Node::Kind::kScalar ? valueOf(value.text, kind) : std::nullopt;
    const bool may_be_zero = kind == NumberKind::kRatio || kind == NumberKind::kDamping ||
                             kind == NumberKind::kForce || kind == NumberKind::kForcePerLength;
    if (!parsed || *parsed < 0.0 || (*parsed == 0.0 && !may_be_zero)) {
      throw document.error(
          value.mark, "tissues.value",
          "'" + what + "' must be " + unitsOf(kind) + ", not '" + value.text + "'");
    }
    SourcedNumber result;
    readSource(reader, result);
    result.value = *parsed;
    result.text = value.text;
    reader.finish();
    return result;
  }

  SourcedTransfer transfer(const Node& node) {
    const Document& document = loader_.document();
    MapReader reader(loader_, node, "stiffness_of_ct");
    const Node& list = reader.require("value");
    const auto wrong = [&](Mark mark, const std::string& what) {
      return document.error(mark, "tissues.transfer", what,
                            "write value: [[-100, 65 N/m], [50, 156 N/m]]: Hounsfield units, by "
                            "rising value, and the stiffness there, more than 0");
    };
    if (list.kind != Node::Kind::kSequence || list.items.empty()) {
      throw wrong(list.mark, "'stiffness_of_ct' must be a list of points");
    }
    SourcedTransfer result;
    for (const Node& item : list.items) {
      const bool is_pair = item.kind == Node::Kind::kSequence && item.items.size() == 2 &&
                           item.items[0].kind == Node::Kind::kScalar &&
                           item.items[1].kind == Node::Kind::kScalar;
      if (!is_pair) throw wrong(item.mark, "a point of 'stiffness_of_ct' is a pair");
      const std::optional<double> from = parseNumber(item.items[0].text);
      const std::optional<double> to = valueOf(item.items[1].text, NumberKind::kStiffness);
      if (!from) {
        throw wrong(item.items[0].mark, "'" + item.items[0].text + "' is not a CT number");
      }
      if (!to || !(*to > 0.0)) {
        throw wrong(item.items[1].mark, "'" + item.items[1].text + "' is not a stiffness above 0");
      }
      if (!result.points.empty() && !(*from > result.points.back().first)) {
        throw wrong(item.items[0].mark, "the CT numbers do not rise");
      }
      result.points.emplace_back(*from, *to);
      result.text += (result.text.empty() ? "[[" : ", [") + item.items[0].text + ", " +
                     item.items[1].text + "]";
    }
    result.text += "]";
    readSource(reader, result);
    reader.finish();
    return result;
  }

  template <typename Sourced>
  static void readSource(MapReader& reader, Sourced& result) {
    const std::string basis = reader.requireText("basis");
    if (basis == "measured") {
      result.basis = Basis::kMeasured;
    } else if (basis == "derived") {
      result.basis = Basis::kDerived;
    } else if (basis != "assumed") {
      throw reader.errorAt("basis", "tissues.basis", "'basis' is '" + basis + "'",
                           "write measured, derived or assumed");
    }
    result.source = reader.requireText("source");
  }

  Tissue tissue(const Node::Entry& entry) {
    Tissue made;
    made.name = entry.key;
    MapReader reader(loader_, entry.value, "a tissue");
    if (const Node* labels = reader.optional("labels")) {
      made.labels = loader_.texts(*labels, "labels");
    }
    const std::string class_name = reader.textOr("class", "");
    const std::string parcels = reader.textOr("parcels", "apart");
    made.lining = reader.textOr("lining", "");
    made.is_spared = reader.boolOr("spared", false);
    const auto read = [&](const char* key, NumberKind kind) -> std::optional<SourcedNumber> {
      const Node* node = reader.optional(key);
      if (node == nullptr) return std::nullopt;
      return number(*node, key, kind);
    };
    made.stiffness = read("stiffness", NumberKind::kStiffness);
    made.young = read("young", NumberKind::kPressure);
    made.shear = read("shear", NumberKind::kPressure);
    made.poisson = read("poisson", NumberKind::kRatio);
    made.damping = read("damping", NumberKind::kDamping);
    made.friction = read("friction", NumberKind::kRatio);
    made.viscosity = read("viscosity", NumberKind::kDamping);
    made.opens_at = read("opens_at", NumberKind::kForce);
    made.back = read("back", NumberKind::kForce);
    made.reopens = read("reopens", NumberKind::kForce);
    made.cutting = read("cutting", NumberKind::kForce);
    made.shaft = read("shaft", NumberKind::kForcePerLength);
    made.shaft_static = read("shaft_static", NumberKind::kForcePerLength);
    if (const Node* node = reader.optional("stiffness_of_ct")) {
      made.stiffness_of_ct = transfer(*node);
    }
    reader.finish();
    if (parcels != "joined" && parcels != "apart") {
      throw loader_.wrong(entry.key_mark, "'parcels' of '" + made.name + "' is joined or apart");
    }
    made.parcels_joined = parcels == "joined";
    setClass(made, class_name, entry.key_mark);
    check(made, entry.key_mark);
    return made;
  }

  void setClass(Tissue& tissue, const std::string& kind, Mark mark) const {
    tissue.kind = tissue.opens_at ? TissueClass::kSolid : TissueClass::kRigid;
    if (!kind.empty()) {
      const std::optional<TissueClass> given = classNamed(kind);
      if (!given || *given == TissueClass::kOutside) {
        throw document().error(mark, "tissues.class",
                               "'" + tissue.name + "' is of class '" + kind + "'",
                               "write rigid, solid, membrane, fluid or gas");
      }
      tissue.kind = *given;
    }
    const bool is_flowing = tissue.kind == TissueClass::kFluid || tissue.kind == TissueClass::kGas;
    const auto refuse = [&](const char* why) {
      return document().error(
          mark, "tissues.class",
          "'" + tissue.name + "' is " + className(tissue.kind) + ", and " + why);
    };
    if (tissue.kind == TissueClass::kRigid && tissue.opens_at) {
      throw refuse("has 'opens_at': nothing gets into what is rigid");
    }
    if (is_flowing && (tissue.hasWall() || tissue.opens_at || tissue.cutting || tissue.shaft)) {
      throw refuse(
          "cannot have a stiffness, opens_at, cutting or shaft; it may have viscosity and a "
          "lining");
    }
    if (tissue.kind == TissueClass::kGas && tissue.viscosity) {
      throw refuse("has viscosity: nothing is felt in a gas");
    }
    if (!is_flowing && !tissue.lining.empty()) {
      throw refuse("has a lining, as only a fluid and a gas have");
    }
  }

  /// Checks that the table has the tissues that `unknown` and linings name.
  void checkNames(const TissueTable& table, const Node& tissues) const {
    if (!table.unknown.empty() && table.find(table.unknown) == nullptr) {
      throw document().error(
          document().root.mark, "tissues.unknown",
          "'unknown' names '" + table.unknown + "', which is not a tissue of this table");
    }
    for (const Tissue& tissue : table.tissues) {
      if (tissue.lining.empty()) continue;
      const Tissue* lining = table.find(tissue.lining);
      if (lining == nullptr || lining->kind != TissueClass::kMembrane || !lining->opens_at) {
        throw document().error(tissues.mark, "tissues.lining",
                               "the lining of '" + tissue.name + "' is '" + tissue.lining + "'",
                               "name a tissue of class membrane with opens_at");
      }
    }
  }

  [[nodiscard]] const Document& document() const { return loader_.document(); }

  void check(const Tissue& tissue, Mark mark) const {
    const Document& document = loader_.document();
    const bool is_flowing = tissue.kind == TissueClass::kFluid || tissue.kind == TissueClass::kGas;
    if (!tissue.hasWall() && !is_flowing) {
      throw document.error(mark, "tissues.stiffness",
                           "'" + tissue.name + "' has no stiffness, and no modulus for one",
                           "give stiffness, young or shear");
    }
    if (tissue.hasWall() && !tissue.stiffness && !tissue.poisson) {
      throw document.error(mark, "tissues.poisson",
                           "'" + tissue.name + "' has a modulus, but no Poisson's ratio",
                           "give poisson: {value: 0.45, ...}");
    }
    if (tissue.poisson && tissue.poisson->value > 0.5) {
      throw document.error(mark, "tissues.poisson",
                           "Poisson's ratio of '" + tissue.name + "' is " + tissue.poisson->text,
                           "it is from 0 to 0.5");
    }
    if ((tissue.back || tissue.reopens) && !tissue.opens_at) {
      throw document.error(
          mark, "tissues.back",
          "'" + tissue.name + "' has 'back' or 'reopens' but no 'opens_at', so it never opens",
          "give opens_at as well");
    }
    if (tissue.shaft && !has_spring_) {
      throw document.error(mark, "tissues.shaft",
                           "'" + tissue.name + "' has 'shaft', but the table has no 'shaft_spring'",
                           "give shaft_spring: {value: 3e4 N/m^2, ...} above 'tissues'");
    }
    if (tissue.shaft_static &&
        (!tissue.shaft || tissue.shaft_static->value < tissue.shaft->value)) {
      throw document.error(mark, "tissues.shaft",
                           "'shaft_static' of '" + tissue.name + "' is less than its 'shaft'",
                           "a shaft that slides is held no harder than one that sticks");
    }
  }

  TableLoader loader_;
  bool has_spring_ = false;
};

}  // namespace

TissueTable readTissueTable(const std::string& path) {
  return TableReader(*readDocument(path)).read();
}

TissueTable ownTissueTable() {
  return TableReader(*parseDocument(kOwnTissues, "tissues.yaml")).read();
}

}  // namespace palpate::tools
