#include <algorithm>
#include <map>

#include "label_share.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/scene_file.h"
#include "survey.h"

namespace palpate {
namespace {

/// Where a layer names no wall (documented in tools/docs/scene.md).
constexpr double kDefaultStiffness = 1000.0;  // [N/m]
constexpr std::size_t kSurveyLines = 192;
constexpr std::size_t kPatientSurveyLines = 4096;

std::string quoted(const std::string& text) { return "'" + text + "'"; }

void checkTexture(const Material& material) {
  const Texture& texture = material.texture;
  if (texture.amplitude == 0.0) return;
  if (texture.amplitude > 0.0 &&
      texture.amplitude <= Texture::highestAmplitude(texture.wavelength)) {
    return;
  }
  throw inputError("scene.texture",
                   "the texture of material " + quoted(material.name) + " is too high",
                   "its amplitude must be from 0 to its wavelength / 2 pi");
}

std::vector<FieldPtr> layerFields(const SceneDescription& description, const Progress& progress) {
  std::vector<FieldPtr> fields;
  std::map<std::string, std::vector<std::size_t>> groups;
  const std::size_t count = description.layers.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LayerDescription& layer = description.layers[i];
    if (!layer.inside) {
      throw errorAt(layer.place, "scene.layer_without_field",
                    "layer " + quoted(layer.name) + " has no field");
    }
    report(progress, "layer " + layer.name, static_cast<double>(i) / static_cast<double>(count));
    fields.push_back(layer.inside->get(progress));
    if (!layer.label_group.empty()) groups[layer.label_group].push_back(i);
  }
  for (const auto& [group, members] : groups) {
    std::vector<FieldPtr> own;
    for (const std::size_t i : members) own.push_back(fields[i]);
    const std::vector<FieldPtr> shared = shareLabels(own);
    for (std::size_t k = 0; k < members.size(); ++k) fields[members[k]] = shared[k];
  }
  return fields;
}

/// The layer boxes to look at, unbounded ones cut to what the others span.
std::vector<Box3> surveyBoxes(std::span<const FieldPtr> layers) {
  Box3 all;
  for (const FieldPtr& field : layers) {
    if (field->bounds().isBounded()) all = all.unitedWith(field->bounds());
  }
  if (all.isEmpty()) all = {Vec3(-0.1), Vec3(0.1)};
  all = all.grownBy(0.25 * glm::length(all.size()));
  std::vector<Box3> boxes{all};
  for (const FieldPtr& field : layers) {
    const Box3 box = field->bounds().intersectedWith(all);
    if (box.isBounded()) boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

/// Builds one Scene; each step is one kind of thing.
class SceneCompiler {
 public:
  SceneCompiler(const SceneDescription& description, const Progress& progress)
      : description_(description),
        layers_(layerFields(description, progress)),
        scene_(new Scene(makePartition(progress))) {}

  ScenePtr build() {
    regions();
    materials();
    lookAround();
    std::vector<Wall> walls = makeWalls();
    std::vector<Port> ports = makePorts();
    scene_->passages_ = Passages(count(), std::move(walls), std::move(ports), makeSheets());
    scene_->start_ = start();
    scene_->touch_ = survey_.touch;
    markReachable();
    scene_->keep_memory_ = description_.keep_memory;
    scene_->renderer_ = description_.renderer;
    scene_->length_unit_ = description_.length_unit;
    scene_->metres_per_unit_ = description_.metres_per_unit;
    for (const NamedField& field : description_.fields) {
      if (field.source->isMade()) scene_->fields_.push_back(field);
    }
    return scene_;
  }

 private:
  [[nodiscard]] std::size_t count() const { return layers_.size() + 1; }

  Partition makePartition(const Progress& progress) {
    std::vector<FieldPtr> masks;
    for (const PortDescription& port : description_.ports) {
      mask_of_.push_back(port.where ? static_cast<int>(masks.size()) : -1);
      if (port.where) masks.push_back(port.where->get(progress));
    }
    for (const SheetDescription& sheet : description_.sheets) {
      if (!sheet.on) {
        throw errorAt(sheet.place, "scene.sheet_without_field",
                      "sheet " + quoted(sheet.name) + " has no field that it is on");
      }
      sheet_mask_of_.push_back(sheet.where ? static_cast<int>(masks.size()) : -1);
      if (sheet.where) masks.push_back(sheet.where->get(progress));
      sheet_solid_of_.push_back(static_cast<int>(masks.size()));
      masks.push_back(sheet.on->get(progress));
    }
    return Partition(layers_, masks);
  }

  void regions() {
    scene_->regions_.resize(count());
    scene_->regions_[kOutside].name = "outside";
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const LayerDescription& layer = description_.layers[i];
      for (std::size_t j = 0; j <= i; ++j) {
        if (scene_->regions_[j].name == layer.name) {
          throw errorAt(layer.place, "scene.duplicate_layer",
                        "layer name " + quoted(layer.name) + " is taken",
                        "give each layer a name of its own ('outside' is the space around all)");
        }
      }
      Region& region = scene_->regions_[i + 1];
      region.name = layer.name;
      region.field = layers_[i];
      region.source = layer.inside->summary();
    }
  }

  int material(const std::string& name, const SourcePlace& place) {
    for (std::size_t i = 0; i < description_.materials.size(); ++i) {
      if (description_.materials[i].name == name) return static_cast<int>(i);
    }
    std::vector<std::string_view> names;
    for (const Material& m : description_.materials) names.push_back(m.name);
    const std::string near = suggest(name, names);
    throw errorAt(
        place, "scene.unknown_material", "there is no material " + quoted(name),
        near.empty() ? "define it below `materials:`" : "did you mean " + quoted(near) + "?");
  }

  Wall wall(const WallDescription& given, const SourcePlace& place) {
    Wall wall;
    wall.absent = given.absent;
    if (given.absent) return wall;
    if (given.material.empty()) {
      wall.material = static_cast<int>(description_.materials.size());
      return wall;
    }
    wall.material = material(given.material, place);
    if (scene_->materials_[static_cast<std::size_t>(wall.material)].stiffness <= 0.0) {
      throw errorAt(place, "scene.wall_without_stiffness",
                    "material " + quoted(given.material) + " has no stiffness and cannot be a wall",
                    "give it one (stiffness: 1000 N/m), or write `wall: absent`");
    }
    return wall;
  }

  void materials() {
    for (const Material& m : description_.materials) checkTexture(m);
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

  std::vector<RegionId> matching(const std::string& glob, const SourcePlace& place) {
    std::vector<RegionId> out;
    for (std::size_t i = 0; i < count(); ++i) {
      if (matchesGlob(glob, scene_->regions_[i].name)) out.push_back(static_cast<RegionId>(i));
    }
    if (out.empty()) throw unknownRegion(glob, place);
    return out;
  }

  Error unknownRegion(const std::string& name, const SourcePlace& place) {
    std::vector<std::string_view> names;
    for (const Region& region : scene_->regions_) names.push_back(region.name);
    const std::string near = suggest(name, names);
    return errorAt(
        place, "scene.unknown_layer", "there is no layer " + quoted(name),
        near.empty() ? "name a layer, or 'outside'" : "did you mean " + quoted(near) + "?");
  }

  std::vector<Wall> makeWalls() {
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

  std::vector<Port> makePorts() {
    std::vector<Port> ports;
    for (std::size_t i = 0; i < description_.ports.size(); ++i) {
      const PortDescription& given = description_.ports[i];
      Port port;
      port.name = given.name;
      port.from = matching(given.from, given.place);
      port.to = matching(given.to, given.place);
      port.mask = mask_of_[i];
      port.direction = given.direction;
      port.opens_at = given.opens_at;
      port.back = given.back.value_or(given.opens_at);
      if (given.on) port.on = facetLeaves(given, port);
      for (const std::string& before : given.after) port.after.push_back(portNamed(before, given));
      requireTouching(given, port);
      ports.push_back(std::move(port));
    }
    refuseCycles(ports);
    return ports;
  }

  std::vector<Sheet> makeSheets() {
    std::vector<Sheet> sheets;
    for (std::size_t i = 0; i < description_.sheets.size(); ++i) {
      const SheetDescription& given = description_.sheets[i];
      Sheet sheet;
      sheet.name = given.name;
      sheet.leaves = scene_->partition_.leavesOf(given.on->get().get());
      sheet.solid = sheet_solid_of_[i];
      sheet.mask = sheet_mask_of_[i];
      sheet.material = wall({false, given.material}, given.place).material;
      Box3 box = given.on->get()->bounds();
      if (given.where) box = box.intersectedWith(given.where->get()->bounds());
      if (box.isBounded()) scene_->sheet_bounds_ = scene_->sheet_bounds_.unitedWith(box);
      sheets.push_back(std::move(sheet));
    }
    return sheets;
  }

  std::vector<LeafId> facetLeaves(const PortDescription& given, const Port& port) {
    std::vector<LeafId> leaves = scene_->partition_.leavesOf(given.on->get().get());
    const auto bounds = [&](const std::vector<RegionId>& sides) {
      return std::any_of(sides.begin(), sides.end(), [&](RegionId region) {
        const auto own = scene_->partition_.leavesOfRegion(region);
        return std::any_of(leaves.begin(), leaves.end(), [&](LeafId leaf) {
          return std::find(own.begin(), own.end(), leaf) != own.end();
        });
      });
    };
    if (leaves.empty() || !(bounds(port.from) || bounds(port.to))) {
      throw errorAt(
          given.place, "scene.port_face",
          "port " + quoted(given.name) + " is on " + quoted(given.on_name) +
              ", which is no part of " + quoted(given.from) + " or " + quoted(given.to),
          given.on_note.empty()
              ? "name a field that the layer's `inside` is made from, or use `where:` for an "
                "opening of any shape"
              : given.on_note + ", or use `where:` for an opening of any shape");
    }
    return leaves;
  }

  PortId portNamed(const std::string& name, const PortDescription& asker) {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < description_.ports.size(); ++i) {
      if (description_.ports[i].name == name) return static_cast<PortId>(i);
      names.push_back(description_.ports[i].name);
    }
    const std::string near = suggest(name, names);
    throw errorAt(asker.place, "scene.unknown_port", "there is no port " + quoted(name),
                  near.empty() ? "" : "did you mean " + quoted(near) + "?");
  }

  void requireTouching(const PortDescription& given, const Port& port) {
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
      // Small contacts escape the quick look; before calling the author wrong, look hard, once.
      patient_ = true;
      survey_ = survey(scene_->partition_, boxes_, kPatientSurveyLines);
      if (touching()) return;
    }
    throw errorAt(given.place, "scene.regions_do_not_touch",
                  "port " + quoted(given.name) + " joins " + quoted(given.from) + " and " +
                      quoted(given.to) + ", which do not touch",
                  "a port opens the wall between two neighbours; `palpate explain` lists them");
  }

  static void refuse(const PortDescription& given) {
    throw errorAt(given.place, "scene.port_cycle",
                  "port " + quoted(given.name) + " can only be passed after itself",
                  "break the circle of `after:`");
  }

  void refuseCycles(const std::vector<Port>& ports) {
    enum class Visit { kNew, kOpen, kDone };
    std::vector<Visit> marks(ports.size(), Visit::kNew);
    const std::function<void(std::size_t)> visit = [&](std::size_t i) {
      if (marks[i] == Visit::kDone) return;
      if (marks[i] == Visit::kOpen) refuse(description_.ports[i]);
      marks[i] = Visit::kOpen;
      for (const PortId before : ports[i].after) visit(before);
      marks[i] = Visit::kDone;
    };
    for (std::size_t i = 0; i < ports.size(); ++i) visit(i);
  }

  void lookAround() {
    boxes_ = surveyBoxes(layers_);
    survey_ = survey(scene_->partition_, boxes_, kSurveyLines);
  }

  RegionId start() {
    for (std::size_t i = 0; i < count(); ++i) {
      if (scene_->regions_[i].name == description_.start_region) return static_cast<RegionId>(i);
    }
    throw unknownRegion(description_.start_region, description_.start_place);
  }

  /// Follows absent walls and ports from the start; a port counts once those before it can be passed.
  void markReachable() {
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

  bool spread(RegionId a, RegionId b, std::vector<bool>& passable) {
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

  const SceneDescription& description_;
  std::vector<FieldPtr> layers_;
  std::vector<int> mask_of_;
  std::vector<int> sheet_mask_of_;
  std::vector<int> sheet_solid_of_;
  std::shared_ptr<Scene> scene_;
  std::vector<Box3> boxes_;
  Survey survey_;
  bool patient_ = false;
};

ScenePtr compile(const SceneDescription& description, const Progress& progress) {
  return SceneCompiler(description, progress).build();
}

}  // namespace palpate
