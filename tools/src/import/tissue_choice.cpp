#include "import/tissue_choice.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "import/tissue_names.h"
#include "label_range.h"
#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"

namespace palpate::tools {
namespace {

/// One PATTERN=TISSUE.
struct Rule {
  std::string text;     ///< as it was written
  std::string pattern;  ///< simplified
  std::optional<std::pair<int, int>> range;
  const Tissue* tissue = nullptr;
  bool must_fit = false;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t from = text.find_first_not_of(kBlanks);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlanks) - from + 1);
}

class Chooser {
 public:
  Chooser(const ImportOptions& options, const LabelNames& labels, const TissueTable& tissues,
          std::vector<std::string>& notes)
      : options_(options), labels_(labels), tissues_(tissues), notes_(notes) {
    if (!options_.tissue_file.empty()) readFile();
    for (const std::string& text : options_.tissues) {
      const auto wrong = [&](const std::string& what, const std::string& hint) {
        return Error(ErrorKind::kUsage, {"usage.import", "--tissue " + text + ": " + what, hint});
      };
      rules_.push_back(rule(text, true, wrong));
    }
  }

  std::vector<TissueChoice> choose(const std::vector<NamedLabels>& regions) {
    std::vector<std::string> names;
    for (const NamedLabels& region : regions) names.push_back(region.name);
    const std::vector<NameVerdict> by_name = TissueNames::own().of(names);
    std::vector<TissueChoice> choices;
    std::vector<bool> fitted(rules_.size(), false);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      for (std::size_t n = 0; n < rules_.size(); ++n) {
        if (fitsRule(rules_[n], regions[r])) fitted[n] = true;
      }
      choices.push_back(one(regions[r], by_name[r]));
    }
    for (std::size_t n = 0; n < rules_.size(); ++n) {
      if (fitted[n] || !rules_[n].must_fit) continue;
      std::vector<std::string_view> candidates;
      for (const std::string& name : names) candidates.emplace_back(name);
      const std::string close =
          suggest(rules_[n].text.substr(0, rules_[n].text.rfind('=')), candidates);
      throw Error(
          ErrorKind::kUsage,
          {"usage.import", "--tissue " + rules_[n].text + ": there is no such region",
           close.empty() ? "palpate info SCAN lists the labels" : "did you mean '" + close + "'?"});
    }
    return choices;
  }

 private:
  template <typename Wrong>
  Rule rule(std::string_view text, bool must_fit, const Wrong& wrong) const {
    const std::size_t equals = text.rfind('=');
    const std::string_view pattern =
        equals == std::string_view::npos ? "" : trimmed(text.substr(0, equals));
    const std::string tissue(equals == std::string_view::npos ? ""
                                                              : trimmed(text.substr(equals + 1)));
    if (pattern.empty() || tissue.empty()) {
      throw wrong("this is not LABELS=TISSUE",
                  R"(write "Outer-Table=bone", "rib*=bone" or 5-28=muscle)");
    }
    Rule result{std::string(text), simplified(pattern), labelRange(pattern), tissues_.find(tissue),
                must_fit};
    if (result.tissue == nullptr) {
      std::vector<std::string_view> names;
      std::string all;
      for (const Tissue& one : tissues_.tissues) {
        names.push_back(one.name);
        all += (all.empty() ? "" : ", ") + one.name;
      }
      const std::string close = suggest(tissue, names);
      throw wrong("there is no tissue '" + tissue + "'",
                  close.empty() ? "tissues: " + all : "did you mean '" + close + "'?");
    }
    return result;
  }

  void readFile() {
    std::ifstream file(options_.tissue_file);
    if (!file) {
      throw inputError("file.missing", "the file of tissues cannot be read", "",
                       options_.tissue_file);
    }
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      const std::string_view text = trimmed(line);
      if (text.empty() || text.starts_with('#')) continue;
      const auto wrong = [&](const std::string& what, const std::string& hint) {
        return inputError(
            "tissues.line",
            "line " + std::to_string(number) + ", `" + std::string(text) + "`: " + what, hint,
            options_.tissue_file);
      };
      rules_.push_back(rule(text, false, wrong));
    }
  }

  [[nodiscard]] const std::string* nameOf(int label) const {
    const auto at = labels_.names.find(label);
    return at == labels_.names.end() ? nullptr : &at->second;
  }

  /// A region fits if its own name does, or if all of its labels do.
  [[nodiscard]] bool fitsRule(const Rule& rule, const NamedLabels& region) const {
    if (matchesGlob(rule.pattern, simplified(region.name))) return true;
    return std::all_of(region.labels.begin(), region.labels.end(), [&](int label) {
      if (rule.range && label >= rule.range->first && label <= rule.range->second) return true;
      const std::string* name = nameOf(label);
      return name != nullptr && matchesGlob(rule.pattern, simplified(*name));
    });
  }

  /// The tissue that all labels of a region share, or nothing.
  template <typename Of>
  [[nodiscard]] static std::optional<std::string> agreed(const std::vector<int>& labels,
                                                         const Of& of) {
    std::optional<std::string> tissue;
    for (const int label : labels) {
      const std::optional<std::string> one = of(label);
      if (!one || (tissue && *tissue != *one)) return std::nullopt;
      tissue = one;
    }
    return tissue;
  }

  [[nodiscard]] const vdb::LabelCode* codeOf(int label) const {
    const auto at = labels_.codes.find(label);
    return at == labels_.codes.end() ? nullptr : &at->second;
  }

  static std::string textOf(const vdb::LabelCode& code) {
    return "code " + code.scheme + " " + code.value + " (" + code.meaning + ")";
  }

  /// Decides by the list of codes, or else by the words that accompany the code.
  [[nodiscard]] NameVerdict byCode(const NamedLabels& region) const {
    const std::optional<std::string> tissue =
        agreed(region.labels, [&](int label) -> std::optional<std::string> {
          const vdb::LabelCode* code = codeOf(label);
          if (code == nullptr) return std::nullopt;
          const std::optional<std::string> listed = TissueNames::own().ofCode(*code);
          if (listed) return *listed == "none" ? std::nullopt : listed;
          const std::string by_words = TissueNames::own().of({code->meaning}).front().tissue;
          return by_words.empty() ? std::nullopt : std::optional(by_words);
        });
    if (!tissue) return {};
    return {*tissue, textOf(*codeOf(region.labels.front()))};
  }

  [[nodiscard]] std::optional<TissueChoice> known(const std::string& tissue,
                                                  std::string why) const {
    const Tissue* found = tissues_.find(tissue);
    if (found == nullptr) return std::nullopt;
    return TissueChoice{found, std::move(why), true};
  }

  TissueChoice one(const NamedLabels& region, const NameVerdict& by_name) {
    const auto rule = std::find_if(rules_.rbegin(), rules_.rend(),
                                   [&](const Rule& each) { return fitsRule(each, region); });
    if (rule != rules_.rend()) {
      return {rule->tissue, rule->must_fit ? "--tissue " + rule->text : "line " + rule->text, true};
    }
    if (const Tissue* tissue = tissues_.of(region.name))
      return {tissue, "pattern of the table", true};
    const NameVerdict by_code = byCode(region);
    if (const auto choice = known(by_code.tissue, by_code.why)) {
      if (!by_name.tissue.empty() && by_name.tissue != by_code.tissue) {
        notes_.push_back("'" + region.name + "' is " + by_name.tissue + " by its name (" +
                         by_name.why + ") and " + by_code.tissue + " by its " + by_code.why +
                         ": the code decides; --tissue overrides it");
      }
      return *choice;
    }
    if (!options_.codes.empty()) {
      const auto tissue = agreed(region.labels, [&](int label) {
        return TissueNames::own().ofNumber(options_.codes, label);
      });
      if (tissue) {
        if (const auto choice = known(*tissue, "number of " + options_.codes + "'s table"))
          return *choice;
      }
    }
    if (const auto choice = known(by_name.tissue, by_name.why)) return *choice;
    const auto of_label = [&](int label) -> std::optional<std::string> {
      const std::string* name = nameOf(label);
      if (name == nullptr) return std::nullopt;
      const std::string tissue = TissueNames::own().of({*name}).front().tissue;
      return tissue.empty() ? std::nullopt : std::optional(tissue);
    };
    if (const auto tissue = agreed(region.labels, of_label)) {
      if (const auto choice = known(*tissue, "all of its labels are")) return *choice;
    }
    const Tissue* unknown = tissues_.unknown.empty() ? nullptr : tissues_.find(tissues_.unknown);
    if (unknown == nullptr) {
      throw inputError(
          "tissues.none", "no tissue fits the region '" + region.name + "'",
          "give it one (--tissue), or let the last tissue of the table take all: labels: [\"*\"]",
          tissues_.file);
    }
    return {unknown,
            by_name.tissue.empty() ? by_name.why : "the table has no tissue " + by_name.tissue,
            false};
  }

  const ImportOptions& options_;
  const LabelNames& labels_;
  const TissueTable& tissues_;
  std::vector<std::string>& notes_;
  std::vector<Rule> rules_;  ///< later ones win
};

}  // namespace

std::string simplified(std::string_view name) {
  std::string result(name);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) {
    return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
  });
  return result;
}

std::vector<TissueChoice> chooseTissues(const ImportOptions& options,
                                        const std::vector<NamedLabels>& regions,
                                        const LabelNames& labels, const TissueTable& tissues,
                                        std::vector<std::string>& notes) {
  return Chooser(options, labels, tissues, notes).choose(regions);
}

}  // namespace palpate::tools
