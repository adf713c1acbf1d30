// SceneCompiler's look at what touches what, and at what can be reached.

#include <algorithm>
#include <span>

#include "scene_compiler.h"

namespace palpate {
namespace {

constexpr std::size_t kSurveyLines = 192;

/// The layer boxes to look at, unbounded ones cut to what the others span.
std::vector<Box3> surveyBoxes(std::span<const FieldPtr> layers, const Box3& needed) {
  Box3 all;
  for (const FieldPtr& field : layers) {
    if (!field) continue;
    Box3 box = field->bounds();
    if (!box.isBounded()) box = box.intersectedWith(needed);  // cut off there
    if (box.isBounded()) all = all.unitedWith(box);
  }
  if (all.isEmpty()) all = {Vec3(-0.1), Vec3(0.1)};
  all = all.grownBy(0.25 * glm::length(all.size()));
  std::vector<Box3> boxes{all};
  for (const FieldPtr& field : layers) {
    if (!field) continue;
    const Box3 box = field->bounds().intersectedWith(all);
    if (box.isBounded()) boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

void SceneCompiler::lookAround() {
  boxes_ = surveyBoxes(layers_, needed_);
  survey_ = survey(scene_->partition_, boxes_, kSurveyLines);
}

RegionId SceneCompiler::start() {
  for (std::size_t i = 0; i < count(); ++i) {
    if (scene_->regions_[i].name == description_.start_region) return static_cast<RegionId>(i);
  }
  throw unknownRegion(description_.start_region, description_.start_place);
}

void SceneCompiler::markReachable() {
  for (std::size_t i = 0; i < count(); ++i) {
    Region& region = scene_->regions_[i];
    region.reachable = false;
    region.has_seed = survey_.has_seed[i];
    region.seed = survey_.seed[i];
  }
  scene_->regions_[scene_->start_].reachable = true;
  std::vector<bool> passable(scene_->ports().size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < count(); ++a) {
      if (!scene_->regions_[a].reachable) continue;
      for (std::size_t b = 0; b < count(); ++b) {
        if (a == b || !survey_.touches(static_cast<RegionId>(a), static_cast<RegionId>(b)))
          continue;
        changed |= spread(static_cast<RegionId>(a), static_cast<RegionId>(b), passable);
      }
    }
  }
}

bool SceneCompiler::spread(RegionId a, RegionId b, std::vector<bool>& passable) {
  bool open = scene_->passages_.wall(a, b).absent;
  bool changed = false;
  for (const PortId id : scene_->passages_.portsOf(a)) {
    const Port& port = scene_->ports()[id];
    if (!port.leads(a, b) || !std::all_of(port.after.begin(), port.after.end(),
                                          [&](PortId before) { return passable[before]; })) {
      continue;
    }
    open = true;
    if (!passable[id]) changed = passable[id] = true;
  }
  Region& region = scene_->regions_[b];
  if (open && !region.reachable) changed = region.reachable = true;
  return changed;
}

}  // namespace palpate
