#pragma once
/// Which labels of a scan become which regions.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "import/tissue_choice.h"
#include "import/tissue_table.h"
#include "options.h"
#include "palpate/vdb/image.h"

namespace palpate::tools {

struct PlannedRegion {
  std::string name;         ///< as a layer may be called
  std::vector<int> labels;  ///< that the image holds
  const Tissue* tissue = nullptr;
  std::string why = {};  ///< what decided the tissue
  bool is_known = true;  ///< false: nothing fits, and the tissue is the table's `unknown`
};

struct RegionPlan {
  /// Gases, fluids, solids, membranes, what is rigid; in each class soft ones first.
  std::vector<PlannedRegion> regions;
  std::vector<std::string> notes;  ///< what was assumed
};

/// The region of what no label is.
inline constexpr const char* kGapName = "soft_tissue";

/// `counts`: voxels of each label of the image.
/// @throws Error: kInput for labels that the table or the image does not hold, kUsage for a
/// --region that is not NAME=LABELS, or a label in two regions; as chooseTissues().
[[nodiscard]] RegionPlan planRegions(const ImportOptions& options,
                                     const std::map<int, std::uint64_t>& counts,
                                     const LabelNames& labels, const TissueTable& tissues);

}  // namespace palpate::tools
