#include <algorithm>
#include <map>

#include "material_checks.h"
#include "need.h"
#include "palpate/scene/suggestion.h"
#include "scene_compiler.h"

namespace palpate {
namespace {

/// Stiffness of a wall whose layer names no material (documented in tools/docs/scene.md).
constexpr double kDefaultStiffness = 1000.0;  // [N/m]

std::vector<FieldPtr> layerFields(const SceneDescription& description, const Box3& needed,
                                  const Progress& progress,
                                  const std::vector<std::string>& left_out,
                                  std::vector<LeafBetween>& between) {
  std::vector<FieldPtr> fields;
  std::map<std::string, std::vector<std::size_t>> groups;
  const std::size_t count = description.layers.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LayerDescription& layer = description.layers[i];
    if (!layer.inside) {
      throw errorAt(layer.place, "scene.layer_without_field",
                    "layer " + inQuotes(layer.name) + " has no field");
    }
    if (!left_out[i].empty()) {
      fields.emplace_back();
      continue;
    }
    report(progress, "layer " + layer.name, static_cast<double>(i) / static_cast<double>(count));
    fields.push_back(layer.inside->get(needed, progress));
    if (!layer.label_group.empty()) groups[layer.label_group].push_back(i);
  }
  for (const auto& [group, members] : groups) {
    std::vector<LabelField> own;
    for (const std::size_t i : members) own.push_back({fields[i], description.layers[i].labels});
    const SharedLabels shared = shareLabels(own);
    for (std::size_t k = 0; k < members.size(); ++k) fields[members[k]] = shared.fields[k];
    between.insert(between.end(), shared.walls.begin(), shared.walls.end());
  }
  return fields;
}

}  // namespace

SceneCompiler::SceneCompiler(const SceneDescription& description, const Progress& progress,
                             Purpose purpose)
    : description_(description),
      needed_(purpose == Purpose::kTouch ? neededBox(description) : Box3::everything()),
      // All layers are needed there: the paper's table has a row for every layer.
      left_out_(purpose == Purpose::kTouch && description.renderer != RendererKind::kPaper
                    ? reasonsToLeaveOut(description, progress)
                    : std::vector<std::string>(description.layers.size())),
      layers_(layerFields(description, needed_, progress, left_out_, between_)),
      scene_(new Scene(makePartition(progress))) {}

ScenePtr SceneCompiler::build() {
  regions();
  materials();
  lookAround();
  std::vector<Wall> walls = makeWalls();
  std::vector<Port> ports = makePorts();
  scene_->passages_ =
      std::make_unique<const Passages>(count(), std::move(walls), std::move(ports), makeSheets());
  scene_->ports_ = scene_->passages_->ports();
  scene_->start_ = start();
  scene_->touch_ = survey_.touch;
  scene_->keep_memory_ = description_.keep_memory;
  scene_->force_ = description_.force;
  scene_->paper_ = description_.paper;
  markReachable();
  scene_->renderer_ = description_.renderer;
  scene_->device_ = description_.device;
  scene_->length_unit_ = description_.length_unit;
  scene_->meters_per_unit_ = description_.meters_per_unit;
  for (const NamedField& field : description_.fields) {
    if (field.source->isMade()) scene_->fields_.push_back(field);
  }
  return scene_;
}

Partition SceneCompiler::makePartition(const Progress& progress) {
  std::vector<FieldPtr> masks;
  for (const PortDescription& port : description_.ports) {
    const bool is_limited = port.where && !isNowhere(port.from) && !isNowhere(port.to);
    mask_of_.push_back(is_limited ? static_cast<int>(masks.size()) : -1);
    if (is_limited) masks.push_back(made(port.where, progress));
  }
  for (const SheetDescription& sheet : description_.sheets) {
    if (!sheet.on) {
      throw errorAt(sheet.place, "scene.sheet_without_field",
                    "sheet " + inQuotes(sheet.name) + " does not say which field it is on");
    }
    sheet_mask_of_.push_back(sheet.where ? static_cast<int>(masks.size()) : -1);
    if (sheet.where) masks.push_back(made(sheet.where, progress));
    sheet_solid_of_.push_back(static_cast<int>(masks.size()));
    masks.push_back(made(sheet.on, progress));
  }
  return Partition(layers_, masks, between_);
}

void SceneCompiler::regions() {
  scene_->regions_.resize(count());
  scene_->regions_[kOutside].name = "outside";
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const LayerDescription& layer = description_.layers[i];
    for (std::size_t j = 0; j <= i; ++j) {
      if (scene_->regions_[j].name == layer.name) {
        throw errorAt(layer.place, "scene.duplicate_layer",
                      "layer name " + inQuotes(layer.name) + " is taken",
                      "give each layer a name of its own ('outside' is the space around all)");
      }
    }
    Region& region = scene_->regions_[i + 1];
    region.name = layer.name;
    region.field = layers_[i];
    region.source = layer.inside->summary();
    region.left_out = left_out_[i];
  }
}

int SceneCompiler::material(const std::string& name, const SourcePlace& place) {
  for (std::size_t i = 0; i < description_.materials.size(); ++i) {
    if (description_.materials[i].name == name) return static_cast<int>(i);
  }
  throw errorAt(
      place, "scene.unknown_material", "there is no material " + inQuotes(name),
      suggestionFor(name, description_.materials, "define it below `materials:`", &Material::name));
}

Wall SceneCompiler::wall(const WallDescription& given, const SourcePlace& place) {
  Wall wall;
  wall.absent = given.absent;
  if (given.absent) return wall;
  if (given.material.empty()) {
    wall.material = static_cast<int>(description_.materials.size());
    return wall;
  }
  wall.material = material(given.material, place);
  const Parameter& stiffness =
      scene_->materials_[static_cast<std::size_t>(wall.material)].stiffness;
  if (stiffness.range().least <= 0.0) {
    throw errorAt(
        place, "scene.wall_without_stiffness",
        stiffness.range().most > 0.0
            ? "material " + inQuotes(given.material) +
                  " has places without stiffness and cannot be a wall"
            : "material " + inQuotes(given.material) + " has no stiffness and cannot be a wall",
        "give it one (stiffness: 1000 N/m), or write `wall: absent`");
  }
  return wall;
}

void SceneCompiler::materials() {
  for (const Material& m : description_.materials) checkMaterial(m);
  scene_->materials_ = description_.materials;
  Material standard;
  standard.name = "default wall";
  standard.stiffness = kDefaultStiffness;
  scene_->materials_.push_back(standard);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const LayerDescription& layer = description_.layers[i];
    Region& region = scene_->regions_[i + 1];
    if (!layer.content.empty()) region.content = material(layer.content, layer.place);
    const Wall own = wall(layer.wall, layer.place);
    region.wall = own.material;
    region.wall_absent = own.absent;
  }
}

bool SceneCompiler::isNowhere(const std::string& globs) const {
  bool is_any = false;
  for (const std::string& glob : globsIn(globs)) {
    for (std::size_t i = 0; i <= description_.layers.size(); ++i) {
      const std::string& name = i == 0 ? std::string("outside") : description_.layers[i - 1].name;
      if (!matchesGlob(glob, name)) continue;
      if (!isLeftOut(static_cast<RegionId>(i))) return false;
      is_any = true;
    }
  }
  return is_any;
}

std::vector<RegionId> SceneCompiler::matching(const std::string& globs, const SourcePlace& place) {
  std::vector<RegionId> out;
  for (const std::string& glob : globsIn(globs)) {
    const std::size_t before = out.size();
    for (std::size_t i = 0; i < count(); ++i) {
      if (matchesGlob(glob, scene_->regions_[i].name)) out.push_back(static_cast<RegionId>(i));
    }
    if (out.size() == before) throw unknownRegion(glob, place);
  }
  if (out.empty()) throw unknownRegion(globs, place);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Error SceneCompiler::unknownRegion(const std::string& name, const SourcePlace& place) {
  return errorAt(
      place, "scene.unknown_layer", "there is no layer " + inQuotes(name),
      suggestionFor(name, scene_->regions_, "name a layer, or 'outside'", &Region::name));
}

std::vector<Wall> SceneCompiler::makeWalls() {
  std::vector<Wall> walls(count() * count());
  for (std::size_t a = 0; a < count(); ++a) {
    for (std::size_t b = 0; b < count(); ++b) {
      const Region& inner = scene_->regions_[std::max(a, b)];
      walls[a * count() + b] = {inner.wall_absent, inner.wall};
    }
  }
  for (const WallOverride& given : description_.walls) {
    const Wall value = wall(given.wall, given.place);
    for (const RegionId a : matching(given.a, given.place)) {
      for (const RegionId b : matching(given.b, given.place)) {
        if (given.felt_from.empty() || matchesGlob(given.felt_from, scene_->regions_[a].name)) {
          walls[a * count() + b] = value;
        }
        if (given.felt_from.empty() || matchesGlob(given.felt_from, scene_->regions_[b].name)) {
          walls[b * count() + a] = value;
        }
      }
    }
  }
  return walls;
}

ScenePtr compile(const SceneDescription& description, const Progress& progress, Purpose purpose) {
  return SceneCompiler(description, progress, purpose).build();
}

}  // namespace palpate
