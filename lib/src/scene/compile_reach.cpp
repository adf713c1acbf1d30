// SceneCompiler's search for regions that touch, and for regions that can be reached.

#include <algorithm>
#include <random>
#include <span>

#include "palpate/interior/partition.h"
#include "palpate/scene/transitions.h"
#include "reach.h"
#include "scene_compiler.h"

namespace palpate {
namespace {

constexpr std::size_t kSurveyLines = 192;
constexpr int kShots = 2000;   // random lines at a port or sheet
constexpr int kHalvings = 40;  // a shot shrinks to 1e-12 of itself

/// The boxes of the layers to survey; unbounded ones are cut to the extent of the others.
std::vector<Box3> surveyBoxes(std::span<const FieldPtr> layers, const Box3& needed) {
  Box3 all;
  for (const FieldPtr& field : layers) {
    if (!field) continue;
    Box3 box = field->bounds();
    if (!box.isBounded()) box = box.intersectedWith(needed);  // the field was cut off at `needed`
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

std::pair<RegionId, RegionId> pairOf(RegionId a, RegionId b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Random straight lines through a box.
class Shots {
 public:
  explicit Shots(const Box3& box) : box_(box) {}
  std::pair<Vec3, Vec3> next() {
    const Vec3 from = anywhere();
    return {from, anywhere()};
  }

 private:
  Vec3 anywhere() {
    const double x = unit_(random_);
    const double y = unit_(random_);
    return box_.lo + Vec3(x, y, unit_(random_)) * box_.size();
  }

  Box3 box_;
  std::mt19937_64 random_{20240301};  // fixed: the same scene gives the same answer
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

}  // namespace

void SceneCompiler::lookAround() {
  boxes_ = surveyBoxes(layers_, needed_);
  survey_ = survey(scene_->partition(), boxes_, kSurveyLines);
}

RegionId SceneCompiler::start() {
  for (std::size_t i = 0; i < count(); ++i) {
    if (scene_->regions_[i].name == description_.start_region) return static_cast<RegionId>(i);
  }
  throw unknownRegion(description_.start_region, description_.start_place);
}

/// The regions in which the sheet was found to lie, within `part` if that is given: samples random
/// lines through its box.
std::vector<bool> SceneCompiler::regionsOfSheet(std::size_t sheet,
                                                const FieldSourcePtr& part) const {
  std::vector<bool> in(count(), false);
  const SheetDescription& given = description_.sheets[sheet];
  const Field& on = *made(given.on);
  Box3 box = on.bounds();
  for (const FieldSourcePtr& limit : {given.where, part}) {
    if (limit) box = box.intersectedWith(made(limit)->bounds());
  }
  if (!box.isBounded()) box = box.intersectedWith(boxes_.front());
  if (box.isEmpty() || !box.isBounded()) return in;
  Shots shots(box.grownBy(1e-3 * glm::length(box.size())));
  for (int shot = 0; shot < kShots; ++shot) {
    auto [a, b] = shots.next();
    const bool is_inside = on.value(a) < 0.0;
    if ((on.value(b) < 0.0) == is_inside) continue;
    for (int k = 0; k < kHalvings; ++k) {
      const Vec3 middle = 0.5 * (a + b);
      ((on.value(middle) < 0.0) == is_inside ? a : b) = middle;
    }
    if ((given.where && !(made(given.where)->value(a) < 0.0)) ||
        (part && !(made(part)->value(a) < 0.0))) {
      continue;
    }
    const RegionId region = scene_->regionAt(a);
    if (region == scene_->regionAt(b)) in[region] = true;
  }
  return in;
}

std::set<std::pair<RegionId, RegionId>> SceneCompiler::findPort(PortId id) const {
  const Port& port = scene_->ports()[id];
  std::set<std::pair<RegionId, RegionId>> wanted;
  Box3 box;
  for (const std::vector<RegionId>* side : {&port.from, &port.to}) {
    for (const RegionId region : *side) {
      if (region != kOutside) box = box.unitedWith(layers_[region - 1U]->bounds());
    }
  }
  for (const RegionId a : port.from) {
    for (const RegionId b : port.to) {
      if (a != b && survey_.touches(a, b)) wanted.insert(pairOf(a, b));
    }
  }
  if (port.on.empty() && port.mask < 0) return wanted;  // a port in all of the wall
  const FieldSourcePtr& where = description_.ports[id].where;
  if (where) box = box.intersectedWith(made(where)->bounds());
  if (!box.isBounded()) box = box.intersectedWith(boxes_.front());
  std::set<std::pair<RegionId, RegionId>> found;
  if (box.isEmpty() || !box.isBounded()) return found;
  const Partition& partition = scene_->partition();
  Shots shots(box.grownBy(0.02 * glm::length(box.size())));
  Signs here(partition.leaves().size());
  Signs there = here;
  for (int shot = 0; shot < kShots && found.size() < wanted.size(); ++shot) {
    auto [a, b] = shots.next();
    partition.signsAt(a, here);
    partition.signsAt(b, there);
    const RegionId from = partition.regionOf(here);
    if (partition.regionOf(there) == from) continue;
    Signs between = here;
    for (int k = 0; k < kHalvings; ++k) {
      const Vec3 middle = 0.5 * (a + b);
      partition.signsAt(middle, between);
      const bool is_before = partition.regionOf(between) == from;
      (is_before ? a : b) = middle;
      (is_before ? here : there) = between;
    }
    const auto pair = pairOf(from, partition.regionOf(there));
    if (!wanted.contains(pair)) continue;
    if (port.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(port.mask), there)) {
      continue;
    }
    const bool is_on =
        port.on.empty() || std::any_of(port.on.begin(), port.on.end(), [&](LeafId leaf) {
          return here.inside(leaf) != there.inside(leaf);
        });
    if (is_on) found.insert(pair);
  }
  return found;
}

void SceneCompiler::markReachable() {
  ReachTable table;
  table.regions = count();
  table.start = scene_->start_;
  table.keeps_memory = scene_->keep_memory_;
  std::vector<std::set<std::pair<RegionId, RegionId>>> found;
  for (std::size_t id = 0; id < scene_->ports().size(); ++id) {
    table.after.push_back(scene_->ports()[id].after);
    found.push_back(findPort(static_cast<PortId>(id)));
  }
  for (const Transition& t : transitions(*scene_)) {
    if (!t.port) {
      table.ways.push_back({t.from, t.to, -1, false, false});
      continue;
    }
    // The regions touch, but they were not seen to touch where the port is open.
    const bool is_doubtful = !found[*t.port].contains(pairOf(t.from, t.to));
    table.ways.push_back(
        {t.from, t.to, *t.port, scene_->ports()[*t.port].countsInward(t.from, t.to), is_doubtful});
  }
  for (std::size_t id = 0; id < scene_->ports().size(); ++id) {
    const Port& port = scene_->ports()[id];
    if (port.sheet < 0) continue;
    const std::vector<bool> lies_in =
        regionsOfSheet(static_cast<std::size_t>(port.sheet), description_.ports[id].where);
    for (std::size_t i = 0; i < count(); ++i) {
      const auto region = static_cast<RegionId>(i);
      const bool is_doubtful = !lies_in[i];  // sampling may miss a small opening
      for (const bool inward : {true, false}) {
        if (port.direction == (inward ? PortDirection::kOut : PortDirection::kIn)) continue;
        table.ways.push_back({region, region, static_cast<int>(id), inward, is_doubtful});
      }
    }
  }
  const Reached reached = reach(table);
  for (std::size_t i = 0; i < count(); ++i) {
    Region& region = scene_->regions_[i];
    region.reach = reached.regions[i];
    region.reachable = region.reach != Reach::kNo;
    region.has_seed = survey_.has_seed[i];
    region.seed = survey_.seed[i];
  }
  scene_->reach_of_port_ = reached.ports;
}

}  // namespace palpate
