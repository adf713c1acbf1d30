#pragma once
/// Which tissue the name or the code of a label means: data/materials/names.yaml, which says how
/// names are read.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::tools {

/// What decided, and for which tissue; no tissue: nothing fits, and why.
struct NameVerdict {
  std::string tissue;
  std::string why;  ///< word "muscle", SNOMED CT 272673000 (Bone)
  bool is_strong =
      false;  ///< more than the name of a structure: words together, or what it is made of
};

/// "ParaHippocampal_L2" as para, hippocampal, l, 2; ordinals as words (3rd: third), what is in
/// brackets left out.
[[nodiscard]] std::vector<std::string> wordsOf(std::string_view name);

class TissueNames {
 public:
  /// The tissue of each name, all of one image: some words mean another thing among others.
  [[nodiscard]] std::vector<NameVerdict> of(const std::vector<std::string>& names) const;
  /// Of a code, if it is one of those that are listed. A tissue of "none": the words have to say
  /// more.
  [[nodiscard]] std::optional<std::string> ofCode(const vdb::LabelCode& code) const;
  /// Of a label's number in a table such as "freesurfer".
  [[nodiscard]] std::optional<std::string> ofNumber(const std::string& table, int number) const;
  [[nodiscard]] std::vector<std::string> numberTables() const;
  /// Each tissue that is named anywhere, once.
  [[nodiscard]] std::vector<std::string> tissues() const;

  /// The project's own. @throws Error (kInput) for anything but such a table.
  [[nodiscard]] static const TissueNames& own();

 private:
  friend class NamesReader;
  using Words = std::vector<std::string>;
  struct Word {
    std::string word;  ///< with * at its end: a beginning
    std::string tissue;
  };
  struct Together {
    Words words;
    std::string tissue;
  };
  struct Company {
    std::string word;
    Words among;
    std::string tissue;
  };
  struct Numbers {
    int first = 0;
    int last = 0;
    std::string tissue;
  };
  /// What an image's other names say.
  struct Context {
    bool is_brain = false;
    Words words;  ///< of all names
  };

  [[nodiscard]] bool isAside(const std::string& word) const;
  [[nodiscard]] NameVerdict ofPart(const Words& part, const Words& rest) const;
  [[nodiscard]] NameVerdict ofPlace(const Words& part) const;
  [[nodiscard]] bool isBrain(const Words& words) const;
  [[nodiscard]] NameVerdict one(const std::string& name, const Context& context) const;
  [[nodiscard]] NameVerdict inCompany(NameVerdict verdict, const Words& words,
                                      const Context& context) const;

  Words aside_;
  std::vector<Together> together_;
  std::vector<Word> leading_;
  std::vector<Word> nouns_;
  std::vector<Word> names_;
  std::vector<Word> numbered_;
  std::vector<Word> places_;
  std::vector<Company> company_;
  Words brain_words_;
  std::map<std::pair<std::string, std::string>, std::string> codes_;  ///< scheme and value
  std::map<std::string, std::vector<Numbers>> numbers_;               ///< by table
};

}  // namespace palpate::tools
