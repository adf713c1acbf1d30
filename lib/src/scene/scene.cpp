#include "palpate/scene/scene.h"

#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"
#include "palpate/scene/suggestion.h"

namespace palpate {

Scene::Scene(Partition partition)
    : partition_(std::make_unique<const Partition>(std::move(partition))),
      passages_(std::make_unique<const Passages>()) {}

Scene::~Scene() = default;

RegionId Scene::regionAt(const Vec3& p) const {
  Signs signs(partition_->leaves().size());
  partition_->signsAt(p, signs);
  return partition_->regionOf(signs);
}

RegionId Scene::regionNamed(const std::string& name) const {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    if (regions_[i].name == name) return static_cast<RegionId>(i);
  }
  throw inputError("scene.unknown_layer", "there is no region " + inQuotes(name),
                   suggestionFor(name, regions_, "", &Region::name));
}

Box3 Scene::bounds() const {
  Box3 all = sheet_bounds_;
  for (const Region& region : regions_) {
    if (!region.field) continue;
    Box3 box = region.field->bounds();
    // Beyond the part that was made, a grid's value continues without end.
    if (!box.isBounded() && !region.source.empty()) box = box.intersectedWith(device_.reach());
    if (box.isBounded()) all = all.unitedWith(box);
  }
  return all;
}

}  // namespace palpate
