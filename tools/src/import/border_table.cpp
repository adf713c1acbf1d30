#include "import/border_table.h"

#include <string>
#include <utility>

#include "import/own_tables.h"
#include "import/table_loader.h"

namespace palpate::tools {
namespace {

constexpr std::array<const char*, kTissueClasses> kNames = {"rigid", "solid", "membrane",
                                                            "fluid", "gas",   "outside"};

std::size_t placeOf(TissueClass first, TissueClass second) {
  return static_cast<std::size_t>(first) * kTissueClasses + static_cast<std::size_t>(second);
}

Border::Wall seenFromTheOther(Border::Wall wall) {
  return wall == Border::Wall::kFirst    ? Border::Wall::kSecond
         : wall == Border::Wall::kSecond ? Border::Wall::kFirst
                                         : wall;
}

}  // namespace

class BorderReader {
 public:
  explicit BorderReader(const Document& document) : loader_(document, "borders") {}

  BorderTable read() {
    MapReader root(loader_, loader_.document().root, "a table of borders");
    if (root.requireNumber("palpate_borders") != 1.0) {
      throw root.errorAt("palpate_borders", "borders.version",
                         "this is another version of tables of borders",
                         "write palpate_borders: 1");
    }
    const Node& list = root.require("borders");
    root.finish();
    if (list.kind != Node::Kind::kSequence) throw loader_.wrong(list.mark, "'borders' is a list");
    for (const Node& item : list.items) add(item);
    for (std::size_t a = 0; a + 1 < kTissueClasses; ++a) {
      for (std::size_t b = a; b < kTissueClasses; ++b) {
        if (is_given_.at(a * kTissueClasses + b)) continue;
        throw loader_.wrong(list.mark, std::string("the table has no entry for ") + kNames.at(a) +
                                           " and " + kNames.at(b));
      }
    }
    return table_;
  }

 private:
  void add(const Node& item) {
    MapReader reader(loader_, item, "a border");
    const Node& pair = reader.require("between");
    const std::vector<std::string> names = loader_.texts(pair, "between");
    const auto first = classNamed(names.front());
    const auto second = names.size() == 2 ? classNamed(names.back()) : std::nullopt;
    if (!first || !second) {
      throw loader_.wrong(pair.mark, "'between' must be a list of two classes",
                          "rigid, solid, membrane, fluid, gas, outside");
    }
    Border border;
    const std::string wall = reader.requireText("wall");
    if (wall == names.front() && first != second) {
      border.wall = Border::Wall::kFirst;
    } else if (wall == names.back() && first != second) {
      border.wall = Border::Wall::kSecond;
    } else if (wall == "stiffer") {
      border.wall = Border::Wall::kStiffer;
    } else if (wall != "none") {
      throw loader_.wrong(item.mark, "'wall' must be one of the two classes, stiffer or none");
    }
    const std::string port = reader.textOr("port", "none");
    if (port != "none" && port != "rupture") {
      throw loader_.wrong(item.mark, "'port' is rupture or none");
    }
    border.ruptures = port == "rupture";
    border.lining = reader.boolOr("lining", false);
    reader.finish();
    if (is_given_.at(placeOf(*first, *second))) {
      throw loader_.wrong(item.mark, "the table has an entry for these two already");
    }
    table_.borders_.at(placeOf(*first, *second)) = border;
    is_given_.at(placeOf(*first, *second)) = true;
    border.wall = seenFromTheOther(border.wall);
    table_.borders_.at(placeOf(*second, *first)) = border;
    is_given_.at(placeOf(*second, *first)) = true;
  }

  TableLoader loader_;
  BorderTable table_;
  std::array<bool, kTissueClasses * kTissueClasses> is_given_{};
};

const char* className(TissueClass of) { return kNames.at(static_cast<std::size_t>(of)); }

std::optional<TissueClass> classNamed(std::string_view name) {
  for (std::size_t c = 0; c < kTissueClasses; ++c) {
    if (name == kNames.at(c)) return static_cast<TissueClass>(c);
  }
  return std::nullopt;
}

const Border& BorderTable::between(TissueClass first, TissueClass second) const {
  return borders_.at(placeOf(first, second));
}

const BorderTable& BorderTable::own() {
  static const BorderTable table = BorderReader(*parseDocument(kOwnBorders, "borders.yaml")).read();
  return table;
}

}  // namespace palpate::tools
