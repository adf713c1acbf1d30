#pragma once
/// The tissue of each region: what the user said, else its code, its number or its name.

#include <string>
#include <vector>

#include "import/tissue_table.h"
#include "options.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::tools {

/// What is known of label values.
struct LabelNames {
  vdb::NameTable names;
  vdb::LabelCodes codes;
};

struct TissueChoice {
  const Tissue* tissue = nullptr;
  std::string why;       ///< the word, code or option that decided
  bool is_known = true;  ///< false: nothing fits, and it is the table's `unknown`
};

/// A region that wants a tissue.
struct NamedLabels {
  std::string name;
  std::vector<int> labels;
};

/// In the order of `regions`. `notes` gets what a user should know of a choice.
/// @throws Error: kUsage for a --tissue that names no tissue or fits no region, kInput for such a
/// line of a file, or if nothing fits and the table has no `unknown`.
[[nodiscard]] std::vector<TissueChoice> chooseTissues(const ImportOptions& options,
                                                      const std::vector<NamedLabels>& regions,
                                                      const LabelNames& labels,
                                                      const TissueTable& tissues,
                                                      std::vector<std::string>& notes);

/// Blanks and hyphens as underscores, capitals small: as patterns of names are compared.
[[nodiscard]] std::string simplified(std::string_view name);

}  // namespace palpate::tools
