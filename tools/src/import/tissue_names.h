#pragma once
/// Finds the tissue that the name or the code of a label means, by data/materials/names.yaml, which
/// also says how names are read.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::tools {

/// The tissue, and the word or code that decided it; no tissue: nothing fits, with the reason.
struct NameVerdict {
  std::string tissue;
  std::string why;         ///< word "muscle", SNOMED CT 272673000 (Bone)
  bool is_strong = false;  ///< stronger than the name of a structure alone: a combination of words,
                           ///< or its material
};

/// "ParaHippocampal_L2" as para, hippocampal, l, 2; ordinals as words (3rd: third), text in
/// brackets left out.
[[nodiscard]] std::vector<std::string> wordsOf(std::string_view name);

class TissueNames {
 public:
  /// The tissue of each name. `names` are all names of one image, because some words change their
  /// meaning with the other names.
  [[nodiscard]] std::vector<NameVerdict> of(const std::vector<std::string>& names) const;
  /// The tissue of a code, if it is listed; "none" if the code alone does not decide the tissue.
  [[nodiscard]] std::optional<std::string> ofCode(const vdb::LabelCode& code) const;
  /// The tissue of a label's number in a table such as "freesurfer".
  [[nodiscard]] std::optional<std::string> ofNumber(const std::string& table, int number) const;
  [[nodiscard]] std::vector<std::string> numberTables() const;
  /// All tissues that the lists mention, each once.
  [[nodiscard]] std::vector<std::string> tissues() const;

  /// The project's own lists. @throws Error (kInput) if the file has another form.
  [[nodiscard]] static const TissueNames& own();

 private:
  friend class NamesReader;
  using Words = std::vector<std::string>;
  struct Word {
    std::string word;  ///< a * at its end: any word that begins with the rest
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
  /// Facts from the other names of an image.
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
  std::map<std::string, std::vector<Numbers>> numbers_;               ///< by name of the table
};

}  // namespace palpate::tools
