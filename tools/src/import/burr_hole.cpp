#include "import/burr_hole.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

constexpr const char* kName = "burr_hole";
constexpr const char* kContent = "fluid";
constexpr int kMostLabel = 65'535;  // of the image that is written

/// Labels of all rigid regions except the target.
std::map<int, std::size_t> rigidLabels(const ImportedScan& scan, std::size_t target) {
  std::map<int, std::size_t> out;
  for (std::size_t r = 0; r < scan.plan.regions.size(); ++r) {
    const PlannedRegion& region = scan.plan.regions[r];
    if (r == target || region.tissue->kind != TissueClass::kRigid) continue;
    for (const int label : region.labels) out[label] = r;
  }
  return out;
}

std::string freeName(const ImportedScan& scan) {
  std::string name = kName;
  const auto is_taken = [&] {
    return std::any_of(scan.plan.regions.begin(), scan.plan.regions.end(),
                       [&](const PlannedRegion& region) { return region.name == name; });
  };
  for (int n = 2; is_taken(); ++n) name = std::string(kName) + "_" + std::to_string(n);
  return name;
}

}  // namespace

BurrHole drill(ImportedScan& scan, const TissueTable& tissues, const NeedleWay& way,
               const WayTarget& target, double radius) {
  const Tissue* fluid = tissues.find(kContent);
  if (fluid == nullptr || fluid->kind != TissueClass::kFluid) {
    throw inputError("import.burr_hole",
                     std::string("the table of tissues has no fluid called '") + kContent +
                         "', which fills a burr hole",
                     std::string("add it, with class: fluid"));
  }
  BurrHole hole;
  hole.radius = radius;
  hole.label = scan.counts.empty() ? 1 : std::max(0, scan.counts.rbegin()->first) + 1;
  if (hole.label > kMostLabel) {
    throw inputError("import.burr_hole", "no label is left for the burr hole",
                     "give the image labels below 65535", scan.labels.source);
  }
  const std::map<int, std::size_t> rigid = rigidLabels(scan, target.region);
  const double reach = glm::length(way.entry - way.to);
  const Vec3 along = (way.entry - way.to) / reach;
  double nearest = reach;
  double farthest = 0.0;
  std::set<std::size_t> through;
  std::size_t n = 0;
  for (int k = 0; k < scan.labels.size[2]; ++k) {
    for (int j = 0; j < scan.labels.size[1]; ++j) {
      for (int i = 0; i < scan.labels.size[0]; ++i, ++n) {
        const auto at = rigid.find(static_cast<int>(scan.labels.values[n]));
        if (at == rigid.end()) continue;
        const Vec3 from = scan.labels.toWorld(Vec3(i, j, k)) - way.to;
        const double s = glm::dot(from, along);
        if (s < 0.0 || s > reach + radius) continue;
        if (glm::length(from - s * along) > radius) continue;
        scan.labels.values[n] = static_cast<float>(hole.label);
        through.insert(at->second);
        nearest = std::min(nearest, s);
        farthest = std::max(farthest, s);
        ++hole.voxels;
      }
    }
  }
  if (hole.voxels == 0) {
    throw inputError("import.burr_hole",
                     "the shortest way to '" + way.target + "' meets no bone: no hole is needed",
                     "leave --burr-hole out", scan.labels.source);
  }
  hole.outer = way.to + farthest * along;
  hole.inner = way.to + nearest * along;
  for (const std::size_t r : through) {
    hole.through += (hole.through.empty() ? "" : ", ") + scan.plan.regions[r].name;
  }

  PlannedRegion region{freeName(scan), {hole.label}, fluid, "asked for by --burr-hole"};
  const auto after = std::find_if(
      scan.plan.regions.begin(), scan.plan.regions.end(), [](const PlannedRegion& each) {
        return each.tissue->kind != TissueClass::kGas && each.tissue->kind != TissueClass::kFluid;
      });
  scan.counts[hole.label] = hole.voxels;
  scan.names[hole.label] = region.name;
  scan.plan.regions.insert(after, std::move(region));
  // A bone whose voxels all were drilled away is not a region any more.
  std::set<int> left;
  for (const float value : scan.labels.values) left.insert(static_cast<int>(value));
  std::erase_if(scan.plan.regions, [&](const PlannedRegion& each) {
    return std::none_of(each.labels.begin(), each.labels.end(),
                        [&](int label) { return left.contains(label); });
  });
  return hole;
}

}  // namespace palpate::tools
