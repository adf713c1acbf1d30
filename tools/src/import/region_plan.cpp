#include "import/region_plan.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "label_range.h"
#include "palpate/core/error.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/scan_surface.h"
#include "text.h"

namespace palpate::tools {
namespace {

using Counts = std::map<int, std::uint64_t>;

Error usage(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.import", std::move(message), std::move(hint)});
}

std::string listOf(const Counts& counts) {
  std::string text;
  std::size_t told = 0;
  for (const auto& [label, voxels] : counts) {
    if (label == 0) continue;
    if (++told > 20) return text + ", ...";
    text += (text.empty() ? "" : ", ") + std::to_string(label);
  }
  return text.empty() ? "nothing but 0" : text;
}

/// The labels of the image that `entry` means: 7, 5-28, a name or a pattern.
std::vector<int> labelsOf(const std::string& entry, const ImportOptions& options,
                          const Counts& counts, const vdb::NameTable& names) {
  std::vector<int> wanted;
  const bool is_range = entry.find('-') != std::string::npos;
  const auto range = is_range ? labelRange(entry) : std::nullopt;
  if (range) {
    if (range->first > range->second) throw usage("the range " + entry + " is empty", "write 5-28");
    for (const auto& [label, voxels] : counts) {
      if (label >= range->first && label <= range->second && label != 0) wanted.push_back(label);
    }
  } else {
    wanted = vdb::resolveLabels({entry}, names, options.names);
    if (wanted == std::vector<int>{0}) {
      throw inputError("labels.background", "label 0 means 'not labeled', so it cannot be a region",
                       "--body or --skin makes a region of the unlabeled part of the body",
                       options.scan());
    }
    std::erase_if(wanted, [&](int label) { return label == 0 || !counts.contains(label); });
  }
  if (wanted.empty()) {
    throw inputError("labels.no_voxels", "no voxel of the image has the label `" + entry + "`",
                     "the image holds " + listOf(counts), options.scan());
  }
  return wanted;
}

/// A valid name for a layer; characters with a meaning in scenes become underscores.
std::string layerName(std::string name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7F ||
        std::string_view("*?;,/\"\\").find(c) != std::string_view::npos) {
      c = '_';
    }
  }
  return name == "outside" || name == kGapName ? name + "_label" : name;
}

class Planner {
 public:
  Planner(const ImportOptions& options, const Counts& counts, const LabelNames& labels,
          const TissueTable& tissues)
      : options_(options),
        counts_(counts),
        labels_(labels),
        names_(labels.names),
        tissues_(tissues) {}

  RegionPlan make() {
    for (const std::string& text : options_.regions) addJoined(text);
    std::vector<int> single;
    if (options_.labels.empty()) {
      for (const auto& [label, voxels] : counts_) {
        if (label != 0) single.push_back(label);
      }
    }
    for (const std::string& entry : options_.labels) {
      const std::vector<int> found = labelsOf(entry, options_, counts_, names_);
      single.insert(single.end(), found.begin(), found.end());
    }
    std::sort(single.begin(), single.end());
    single.erase(std::unique(single.begin(), single.end()), single.end());
    const std::size_t joined = plan_.regions.size();
    for (const int label : single) {
      if (!taken_.contains(label)) addSingle(label);
    }
    if (plan_.regions.empty()) {
      throw inputError("labels.none", "the image holds no label: all of its voxels are 0", "",
                       options_.scan());
    }
    setTissues();
    if (names_.empty() && plan_.regions.size() > joined && !plan_.regions.back().is_known) {
      plan_.notes.push_back(
          "the labels have no names, so their tissues are not known: they are taken for " +
          plan_.regions.back().tissue->name +
          "; give names (--names FILE), or say whose numbers they are (--codes freesurfer)");
    }
    const auto rank = [&](const PlannedRegion& region) {
      const Tissue& tissue = *region.tissue;
      // The wall between two layers is the later one's. Rigid tissue must come last: otherwise the
      // wall of the softer tissue would give way in its place.
      constexpr std::array kOrder = {TissueClass::kGas, TissueClass::kFluid, TissueClass::kSolid,
                                     TissueClass::kMembrane, TissueClass::kRigid};
      const auto place = std::find(kOrder.begin(), kOrder.end(), tissue.kind) - kOrder.begin();
      const double stiffness = tissue.hasWall() ? tissues_.wallStiffness(tissue).value : 0.0;
      return std::tuple(place, stiffness, &tissue - tissues_.tissues.data());
    };
    std::stable_sort(plan_.regions.begin(), plan_.regions.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    return std::move(plan_);
  }

 private:
  void addJoined(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos || name.empty() || equals + 1 == text.size()) {
      throw usage("--region " + text + " is not NAME=LABELS",
                  "write --region muscle=5-28, --region 'bone=femur,rib*'");
    }
    if (layerName(name) != name) {
      throw usage("a region cannot be called '" + name + "'",
                  "choose a name without * ? ; , / \" \\, not 'outside' and not '" +
                      std::string(kGapName) + "'");
    }
    PlannedRegion region;
    region.name = name;
    for (const std::string_view entry : split(std::string_view(text).substr(equals + 1), ',')) {
      for (const int label : labelsOf(std::string(entry), options_, counts_, names_)) {
        const auto [at, is_new] = taken_.emplace(label, name);
        if (!is_new && at->second != name) {
          throw usage("label " + std::to_string(label) + " is in the regions '" + at->second +
                          "' and '" + name + "'",
                      "a label belongs to one region");
        }
        if (is_new) region.labels.push_back(label);
      }
    }
    std::sort(region.labels.begin(), region.labels.end());
    if (region.labels.empty()) throw usage("the region '" + name + "' is given twice", "");
    plan_.regions.push_back(std::move(region));
  }

  /// Labels with the same name form one region.
  void addSingle(int label) {
    const auto named = names_.find(label);
    if (named == names_.end() && !names_.empty()) {
      plan_.notes.push_back("label " + std::to_string(label) + " has no name in " +
                            (options_.names.empty() ? options_.scan() : options_.names) +
                            "; it is called label_" + std::to_string(label));
    }
    const std::string name =
        layerName(named == names_.end() ? "label_" + std::to_string(label) : named->second);
    const auto same = std::find_if(plan_.regions.begin(), plan_.regions.end(),
                                   [&](const PlannedRegion& r) { return r.name == name; });
    if (same != plan_.regions.end()) {
      same->labels.push_back(label);
      return;
    }
    plan_.regions.push_back({name, {label}, nullptr});
  }

  void setTissues() {
    std::vector<NamedLabels> regions;
    for (const PlannedRegion& region : plan_.regions)
      regions.push_back({region.name, region.labels});
    const std::vector<TissueChoice> choices =
        chooseTissues(options_, regions, labels_, tissues_, plan_.notes);
    for (std::size_t r = 0; r < choices.size(); ++r) {
      plan_.regions[r].tissue = choices[r].tissue;
      plan_.regions[r].why = choices[r].why;
      plan_.regions[r].is_known = choices[r].is_known;
    }
  }

  const ImportOptions& options_;
  const Counts& counts_;
  const LabelNames& labels_;
  const vdb::NameTable& names_;
  const TissueTable& tissues_;
  std::map<int, std::string> taken_;  ///< labels taken by --region
  RegionPlan plan_;
};

}  // namespace

RegionPlan planRegions(const ImportOptions& options, const Counts& counts, const LabelNames& labels,
                       const TissueTable& tissues) {
  return Planner(options, counts, labels, tissues).make();
}

}  // namespace palpate::tools
