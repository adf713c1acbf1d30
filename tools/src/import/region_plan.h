#pragma once
/// Decides which labels of a scan form which regions.

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
  std::string name;         ///< a valid name for a layer
  std::vector<int> labels;  ///< those that the image holds
  const Tissue* tissue = nullptr;
  std::string why = {};  ///< the reason for the choice of the tissue
  bool is_known = true;  ///< false: no tissue fits, and the table's `unknown` is used
};

struct RegionPlan {
  /// Gases, fluids, solids, membranes, then rigid tissue; in each class soft ones first.
  std::vector<PlannedRegion> regions;
  std::vector<std::string> notes;  ///< what was assumed
};

/// The region of space in the body without a label.
inline constexpr const char* kGapName = "soft_tissue";

/// `counts`: voxels of each label of the image.
/// @throws Error: kInput for labels that the table or the image does not hold, kUsage for a
/// --region that is not NAME=LABELS, or a label in two regions; as chooseTissues().
[[nodiscard]] RegionPlan planRegions(const ImportOptions& options,
                                     const std::map<int, std::uint64_t>& counts,
                                     const LabelNames& labels, const TissueTable& tissues);

}  // namespace palpate::tools
