#pragma once
/// Chooses the tissue of each region: by the user's option, else by code, number or name.

#include <string>
#include <vector>

#include "import/tissue_table.h"
#include "options.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::tools {

/// Names, codes and numbers of label values.
struct LabelNames {
  vdb::NameTable names;
  vdb::LabelCodes codes;
};

struct TissueChoice {
  const Tissue* tissue = nullptr;
  std::string why;       ///< the word, code or option that decided
  bool is_known = true;  ///< false: no tissue fits, and the table's `unknown` is used
};

/// A region that needs a tissue.
struct NamedLabels {
  std::string name;
  std::vector<int> labels;
};

/// One choice for each of `regions`. Adds to `notes` whatever a user should know about a choice.
/// @throws Error: kUsage for a --tissue that names no tissue or fits no region; kInput for a line
/// of the file that names no tissue, or if nothing fits and the table has no `unknown`.
[[nodiscard]] std::vector<TissueChoice> chooseTissues(const ImportOptions& options,
                                                      const std::vector<NamedLabels>& regions,
                                                      const LabelNames& labels,
                                                      const TissueTable& tissues,
                                                      std::vector<std::string>& notes);

/// Blanks and hyphens become underscores, and capitals lower case: the form in which patterns of
/// names are compared.
[[nodiscard]] std::string simplified(std::string_view name);

}  // namespace palpate::tools
