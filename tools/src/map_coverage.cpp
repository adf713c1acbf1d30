#include "map_coverage.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "scene_parameters.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr int kSide = 17;  ///< sample places along each side of a box
/// [share] Less than 1, because up to half a voxel may be missing at the rim
constexpr double kWhole = 0.995;
constexpr double kStrangeRatio = 50;  ///< ratio of sizes above which a unit may be wrong

template <typename Visit>
void eachPlace(const Box3& box, const Visit& visit) {
  const Vec3 step = box.size() / static_cast<double>(kSide);
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        visit(box.lo + step * (Vec3(i, j, k) + Vec3(0.5)));
      }
    }
  }
}

double longestSide(const Box3& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

double distanceBetween(const Box3& a, const Box3& b) {
  Vec3 gap(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    gap[axis] = std::max({0.0, a.lo[axis] - b.hi[axis], b.lo[axis] - a.hi[axis]});
  }
  return glm::length(gap);
}

/// The map's box extends half a voxel beyond its outermost centers.
Box3 reachOf(const vdb::MaterialGridInfo& info) {
  return info.bounds.grownBy(0.5 * info.voxel_size);
}

/// How much of the region is within the map.
MapGap gapOf(const Scene& scene, RegionId region, const SceneParameter& found,
             const vdb::MaterialGridInfo& info) {
  MapGap gap{found.name(), info.source};
  const Box3 map = reachOf(info);
  const FieldPtr& field = scene.regions()[region].field;
  const Box3 bounds = field->bounds();
  std::size_t places = 0;
  std::size_t within = 0;
  if (bounds.isBounded()) {
    gap.size_ratio = longestSide(map) / std::max(longestSide(bounds), 1e-12);
    gap.away = distanceBetween(map, bounds);
    eachPlace(bounds, [&](const Vec3& p) {
      if (field->value(p) > 0.0) return;
      ++places;
      within += map.contains(p) ? 1U : 0U;
    });
    // No sample place is in the layer, because it is thinner than the spacing: sample its whole
    // box.
    if (places == 0) {
      eachPlace(bounds, [&](const Vec3& p) {
        ++places;
        within += map.contains(p) ? 1U : 0U;
      });
    }
    gap.share = static_cast<double>(within) / static_cast<double>(places);
    // A small map may lie between the sample places.
    if (within == 0 && gap.away <= 0.0) {
      eachPlace(map, [&](const Vec3& p) {
        if (field->value(p) <= 0.0) gap.share = 1e-6;
      });
    }
    return gap;
  }
  // An unbounded layer has no share; the only question is whether the map reaches it at all.
  double nearest = kInfinity;
  eachPlace(map, [&](const Vec3& p) { nearest = std::min(nearest, field->value(p)); });
  gap.share = nearest <= 0.0 ? 1.0 : 0.0;
  gap.away = std::max(0.0, nearest);
  return gap;
}

/// The regions whose sample places count for a parameter of `owner`, a layer or a port.
std::set<RegionId> regionsOf(const Scene& scene, const std::string& owner) {
  std::set<RegionId> all;
  for (std::size_t i = 1; i < scene.regions().size(); ++i) {
    if (scene.regions()[i].name == owner) all.insert(static_cast<RegionId>(i));
  }
  for (const Port& port : scene.ports()) {
    if (port.name != owner) continue;
    for (const RegionId from : port.from) {
      for (const RegionId to : port.to) {
        // The wall between two layers belongs to the later one.
        if (scene.touches(from, to)) all.insert(std::max(from, to));
      }
    }
  }
  all.erase(kOutside);
  return all;
}

}  // namespace

std::vector<MapGap> mapGaps(const SceneDescription& description, const Scene& scene) {
  std::vector<MapGap> gaps;
  for (const SceneParameter& found : sceneParameters(description)) {
    const vdb::MaterialGridPtr grid = found.grid();
    if (!grid || !grid->info().bounds.isBounded()) continue;
    std::optional<MapGap> worst;
    for (const RegionId region : regionsOf(scene, found.owner)) {
      if (!scene.regions()[region].field) continue;
      const MapGap gap = gapOf(scene, region, found, grid->info());
      if (!worst || gap.share < worst->share) worst = gap;
    }
    if (worst && worst->share < kWhole) gaps.push_back(*worst);
  }
  return gaps;
}

std::string gapText(const MapGap& gap, const std::string& unit, double meters_per_unit) {
  std::string text = "the map of " + gap.parameter + " (" + gap.source + ") ";
  if (gap.misses()) {
    text += "does not reach its layer";
    if (gap.away > 0.0) {
      text += ": it lies " + formatNumber(gap.away / meters_per_unit, 3) + " " + unit + " away";
    }
  } else {
    text += "covers " + formatNumber(100.0 * gap.share, 2) + " % of its layer";
  }
  text += "; elsewhere the values of its border are used";
  if (gap.size_ratio > kStrangeRatio || gap.size_ratio < 1.0 / kStrangeRatio) {
    text += ". It is " + formatNumber(gap.size_ratio, 2) +
            " times as long as the layer: is its length unit right (units: mm)?";
  }
  return text;
}

}  // namespace palpate::tools
