#include "import/own_tables.h"
#include "import/table_loader.h"
#include "import/tissue_names.h"
#include "label_range.h"

namespace palpate::tools {

class NamesReader {
 public:
  explicit NamesReader(const Document& document) : loader_(document, "names") {}

  TissueNames read() {
    MapReader root(loader_, loader_.document().root, "a table of names");
    if (root.requireNumber("palpate_names") != 1.0) {
      throw root.errorAt("palpate_names", "names.version", "this is another version of such tables",
                         "write palpate_names: 1");
    }
    names_.aside_ = loader_.texts(root.require("aside"), "aside");
    for (const Node::Entry& tissue : loader_.entries(root.require("together"), "together")) {
      for (const Node& entry : tissue.value.items) {
        names_.together_.push_back({loader_.texts(entry, "together"), tissue.key});
      }
    }
    words(root, "leading", names_.leading_);
    words(root, "nouns", names_.nouns_);
    words(root, "names", names_.names_);
    words(root, "numbered", names_.numbered_);
    words(root, "places", names_.places_);
    names_.brain_words_ = loader_.texts(root.require("brain_words"), "brain_words");
    const Node& company = root.require("company");
    for (const Node& item : company.items) {
      MapReader reader(loader_, item, "company");
      TissueNames::Company entry;
      entry.word = reader.requireText("word");
      entry.among = loader_.texts(reader.require("among"), "among");
      entry.tissue = reader.requireText("is");
      reader.finish();
      names_.company_.push_back(std::move(entry));
    }
    for (const Node::Entry& scheme : loader_.entries(root.require("codes"), "codes")) {
      for (const Node::Entry& tissue : loader_.entries(scheme.value, "codes")) {
        for (const std::string& code : loader_.texts(tissue.value, "codes")) {
          names_.codes_[{scheme.key, code}] = tissue.key;
        }
      }
    }
    for (const Node::Entry& table : loader_.entries(root.require("numbers"), "numbers")) {
      for (const Node::Entry& tissue : loader_.entries(table.value, "numbers")) {
        for (const Node& range : tissue.value.items) {
          names_.numbers_[table.key].push_back(numbers(range, tissue.key));
        }
      }
    }
    root.finish();
    return std::move(names_);
  }

 private:
  void words(MapReader& root, const char* key, std::vector<TissueNames::Word>& to) {
    for (const Node::Entry& tissue : loader_.entries(root.require(key), key)) {
      for (const std::string& word : loader_.texts(tissue.value, key)) {
        to.push_back({word, tissue.key});
      }
    }
  }

  /// "7" or "5-28".
  TissueNames::Numbers numbers(const Node& node, const std::string& tissue) {
    const std::string text = loader_.text(node, "numbers");
    const auto range = labelRange(text);
    if (!range || range->first > range->second) {
      throw loader_.wrong(node.mark, "'" + text + "' is neither a number nor a range");
    }
    return {range->first, range->second, tissue};
  }

  TableLoader loader_;
  TissueNames names_;
};

const TissueNames& TissueNames::own() {
  static const TissueNames names = NamesReader(*parseDocument(kOwnNames, "names.yaml")).read();
  return names;
}

}  // namespace palpate::tools
