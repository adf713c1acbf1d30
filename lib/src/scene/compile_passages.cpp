// SceneCompiler's ports and sheets.

#include <algorithm>
#include <cmath>
#include <functional>

#include "palpate/interior/partition.h"
#include "palpate/scene/suggestion.h"
#include "scene_compiler.h"

namespace palpate {
namespace {

constexpr std::size_t kPatientSurveyLines = 4096;

}  // namespace

PortId SceneCompiler::portNamed(const std::string& name, const PortDescription& asker) {
  for (std::size_t i = 0; i < description_.ports.size(); ++i) {
    if (description_.ports[i].name == name) return static_cast<PortId>(i);
  }
  throw errorAt(asker.place, "scene.unknown_port", "there is no port " + inQuotes(name),
                suggestionFor(name, description_.ports, "", &PortDescription::name));
}

int SceneCompiler::sheetNamed(const PortDescription& asker) {
  for (std::size_t i = 0; i < description_.sheets.size(); ++i) {
    if (description_.sheets[i].name == asker.sheet) return static_cast<int>(i);
  }
  throw errorAt(asker.place, "scene.unknown_sheet", "there is no sheet " + inQuotes(asker.sheet),
                suggestionFor(asker.sheet, description_.sheets, "", &SheetDescription::name));
}

std::vector<LeafId> SceneCompiler::facetLeaves(const PortDescription& given, const Port& port) {
  std::vector<LeafId> leaves = scene_->partition().leavesOf(made(given.on).get());
  const auto bounds = [&](const std::vector<RegionId>& sides) {
    return std::any_of(sides.begin(), sides.end(), [&](RegionId region) {
      const auto own = scene_->partition().leavesOfRegion(region);
      return std::any_of(leaves.begin(), leaves.end(), [&](LeafId leaf) {
        return std::find(own.begin(), own.end(), leaf) != own.end();
      });
    });
  };
  if (leaves.empty() || !(bounds(port.from) || bounds(port.to))) {
    throw errorAt(
        given.place, "scene.port_face",
        "port " + inQuotes(given.name) + " is on " + inQuotes(given.on_name) +
            ", which is not part of " + inQuotes(given.from) + " or " + inQuotes(given.to),
        given.on_note.empty()
            ? "name a field that the layer's `inside` is made from, or use `where:` for an "
              "opening of any shape"
            : given.on_note + ", or use `where:` for an opening of any shape");
  }
  return leaves;
}

std::vector<Port> SceneCompiler::makePorts() {
  std::vector<Port> ports;
  for (std::size_t i = 0; i < description_.ports.size(); ++i) {
    const PortDescription& given = description_.ports[i];
    Port port;
    port.name = given.name;
    if (given.sheet.empty()) {
      port.from = matching(given.from, given.place);
      port.to = matching(given.to, given.place);
    } else {
      port.sheet = sheetNamed(given);
    }
    port.mask = mask_of_[i];
    port.direction = given.direction;
    port.opens_at = given.opens_at;
    port.back = given.back.value_or(given.opens_at);
    for (const Parameter& force : {port.opens_at, port.back, given.reopens_at}) {
      const MaterialMap::Range range = force.range();
      if (range.least >= 0.0 && range.least <= range.most && std::isfinite(range.most)) continue;
      throw errorAt(given.place, "scene.parameter",
                    "the force at which port " + inQuotes(given.name) +
                        " opens is negative or not finite somewhere",
                    "opens_at, back and reopens_at must be finite and 0 N or more everywhere");
    }
    if (!(given.rate.ratio > 0.0 && std::isfinite(given.rate.ratio)) ||
        !(given.rate.speed >= 0.0 && std::isfinite(given.rate.speed)) ||
        (given.rate.ratio != 1.0 && given.rate.speed == 0.0)) {
      throw errorAt(given.place, "scene.range",
                    "the rate of port " + inQuotes(given.name) + " is out of range",
                    "its ratio and its speed must be finite and more than 0");
    }
    port.rate = given.rate;
    port.hole_radius = given.hole_radius;
    port.reopens_at = given.reopens_at;
    port.rearm = given.rearm;
    // A port into a layer that was left out leads nowhere; it keeps its index, so that those after
    // it keep theirs.
    const auto leave_out = [&](std::vector<RegionId>& regions) {
      std::erase_if(regions, [&](RegionId region) { return isLeftOut(region); });
    };
    leave_out(port.from);
    leave_out(port.to);
    const bool is_real = !port.from.empty() && !port.to.empty();
    if (given.on && is_real) port.on = facetLeaves(given, port);
    for (const AfterDescription& before : given.after) {
      if (before.times < 1) {
        throw errorAt(given.place, "scene.range",
                      "`after` of port " + inQuotes(given.name) + " asks that " +
                          inQuotes(before.port) + " was passed " + std::to_string(before.times) +
                          " times",
                      "`times` must be 1 or more");
      }
      port.after.emplace_back(portNamed(before.port, given), before.times);
    }
    if (is_real) requireTouching(given, port);
    ports.push_back(std::move(port));
  }
  refuseCycles(ports);
  return ports;
}

std::vector<Sheet> SceneCompiler::makeSheets() {
  std::vector<Sheet> sheets;
  for (std::size_t i = 0; i < description_.sheets.size(); ++i) {
    const SheetDescription& given = description_.sheets[i];
    Sheet sheet;
    sheet.name = given.name;
    sheet.leaves = scene_->partition().leavesOf(made(given.on).get());
    sheet.solid = sheet_solid_of_[i];
    sheet.mask = sheet_mask_of_[i];
    sheet.material = wall({false, given.material}, given.place).material;
    Box3 box = made(given.on)->bounds();
    if (given.where) box = box.intersectedWith(made(given.where)->bounds());
    if (box.isBounded()) scene_->sheet_bounds_ = scene_->sheet_bounds_.unitedWith(box);
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

void SceneCompiler::requireTouching(const PortDescription& given, const Port& port) {
  const auto touching = [&] {
    for (const RegionId a : port.from) {
      for (const RegionId b : port.to) {
        if (a != b && survey_.touches(a, b)) return true;
      }
    }
    return false;
  };
  if (touching()) return;
  if (!patient_) {
    // The quick survey misses small contacts; before reporting an error, survey thoroughly, once.
    patient_ = true;
    survey_ = survey(scene_->partition(), boxes_, kPatientSurveyLines);
    if (touching()) return;
  }
  // The regions may touch in a part of them that was not made.
  const auto is_cut = [&](RegionId region) {
    if (region == kOutside || !needed_.isBounded()) return false;
    const Box3 bounds = layers_[region - 1U]->bounds();
    return !scene_->regions_[region].source.empty() &&
           !(needed_.contains(bounds.lo) && needed_.contains(bounds.hi));
  };
  if (std::any_of(port.from.begin(), port.from.end(), is_cut) ||
      std::any_of(port.to.begin(), port.to.end(), is_cut)) {
    return;
  }
  throw errorAt(given.place, "scene.regions_do_not_touch",
                "port " + inQuotes(given.name) + " joins " + inQuotes(given.from) + " and " +
                    inQuotes(given.to) + ", which do not touch",
                "a port opens the wall between two neighbors; `palpate explain` lists them");
}

void SceneCompiler::refuse(const PortDescription& given) {
  throw errorAt(given.place, "scene.port_cycle",
                "port " + inQuotes(given.name) + " can only be passed after itself",
                "break the circle of `after:`");
}

void SceneCompiler::refuseCycles(const std::vector<Port>& ports) {
  enum class Visit { kNew, kOpen, kDone };
  std::vector<Visit> marks(ports.size(), Visit::kNew);
  const std::function<void(std::size_t)> visit = [&](std::size_t i) {
    if (marks[i] == Visit::kDone) return;
    if (marks[i] == Visit::kOpen) refuse(description_.ports[i]);
    marks[i] = Visit::kOpen;
    for (const PassedBefore& before : ports[i].after) visit(before.port);
    marks[i] = Visit::kDone;
  };
  for (std::size_t i = 0; i < ports.size(); ++i) visit(i);
}

}  // namespace palpate
