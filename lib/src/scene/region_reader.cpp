#include "scene/region_reader.h"

#include <algorithm>

#include "scene/messages.h"
#include "scene/named_items.h"
#include "scene/values.h"

namespace palpate {
namespace {

constexpr std::string_view kOutsideName = "outside";
constexpr std::string_view kAbsent = "absent";
constexpr std::string_view kWallKey = "'wall'";

std::vector<std::string_view> regionNames(const SceneDescription& scene) {
  std::vector<std::string_view> names = namesOf(scene.layers);
  names.insert(names.begin(), kOutsideName);
  return names;
}

bool isGlob(std::string_view text) { return text.find_first_of("*?") != std::string_view::npos; }

}  // namespace

// Names go into traces, grid names and globs, so they must not contain the separators used there.
std::string RegionReader::readName(const MapReader& reader, std::string_view what) {
  std::string name = reader.text("name");
  const auto bad = std::find_if(name.begin(), name.end(), [](char c) {
    return std::string_view("*?;,/\"\\").find(c) != std::string_view::npos ||
           static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  });
  if (bad != name.end()) {
    throw reader.errorAt("name", "scene.name",
                         "the name of a " + std::string(what) + " must not hold " +
                             inQuotes(std::string_view(&*bad, 1)),
                         "letters, digits, spaces and _ - . ( ) are safe");
  }
  if (name.front() == ' ' || name.back() == ' ') {
    throw reader.errorAt("name", "scene.name",
                         "the name of a " + std::string(what) + " begins or ends with a space");
  }
  return name;
}

SourcePlace RegionReader::placeOf(const MapReader& reader, std::string_view key) {
  return reader.loader().document().place(reader.find(key)->mark);
}

const Material& RegionReader::material(const Node& node, const std::string& what) const {
  const std::string name = readText(loader_.document(), node, what);
  const auto found = std::find_if(scene_.materials.begin(), scene_.materials.end(),
                                  [&](const Material& m) { return m.name == name; });
  if (found == scene_.materials.end()) {
    std::vector<std::string_view> names = namesOf(scene_.materials);
    if (what == kWallKey) names.push_back(kAbsent);
    throw unknownName(loader_.document(), node.mark, "material", name, names);
  }
  return *found;
}

WallDescription RegionReader::readWall(const Node& node) const {
  if (node.kind == Node::Kind::kScalar && node.text == kAbsent) return {true, {}};
  const Material& wall = material(node, std::string(kWallKey));
  const MaterialMap::Range stiffness = wall.stiffness.range();
  if (!(stiffness.least > 0.0) && stiffness.most > 0.0) {
    throw loader_.document().error(node.mark, "scene.range",
                                   "the material " + inQuotes(wall.name) +
                                       " has no stiffness in some places, and cannot be a wall",
                                   "let the map of its stiffness be more than 0 N/m everywhere");
  }
  if (!(stiffness.least > 0.0)) {
    throw loader_.document().error(node.mark, "scene.range",
                                   "the material " + inQuotes(wall.name) + " cannot be a wall",
                                   "give it a stiffness, such as 1000 N/m, or write wall: absent");
  }
  return {false, wall.name};
}

void RegionReader::readSurface(const MapReader& reader, LayerDescription& layer) const {
  const Document& document = loader_.document();
  const std::vector<std::string>& kinds = loader_.vocabulary().find("layer")->one_of;
  const Node::Entry* surface = nullptr;
  for (const Node::Entry& entry : reader.node().entries) {
    if (std::find(kinds.begin(), kinds.end(), entry.key) == kinds.end()) continue;
    if (surface != nullptr) {
      throw document.error(
          entry.key_mark, "scene.kind",
          "the layer has both " + inQuotes(surface->key) + " and " + inQuotes(entry.key),
          "give only one of them");
    }
    surface = &entry;
  }
  if (surface == nullptr) {
    throw document.error(reader.node().mark, "scene.missing_key",
                         "the layer " + inQuotes(layer.name) + " does not say where it is",
                         "add inside: FIELD, labels: {...} or threshold: {...}");
  }
  if (surface->key == "inside") {
    layer.inside = loader_.field(surface->value);
    return;
  }
  const auto kind = registry_.layers.find(surface->key);
  if (kind == registry_.layers.end()) {
    throw noReader(document, surface->key_mark, "images, so no " + inQuotes(surface->key));
  }
  MapReader values(loader_, surface->value, inQuotes(surface->key),
                   reader.words(surface->key).type);
  SceneRegistry::LayerSurface made = kind->second(values, layer.name);
  values.finish();
  if (!made.inside) {
    throw document.error(surface->key_mark, "scene.no_reader",
                         "this " + inQuotes(surface->key) + " could not be made");
  }
  layer.inside = std::move(made.inside);
  layer.label_group = std::move(made.label_group);
  layer.labels = std::move(made.labels);
}

void RegionReader::readLayers(const std::vector<MapReader>& layers) {
  for (const MapReader& reader : layers) {
    LayerDescription layer;
    layer.name = readName(reader, "layer");
    layer.place = placeOf(reader, "name");
    if (layer.name == kOutsideName) {
      throw errorAt(layer.place, "scene.name", "a layer cannot be called 'outside'",
                    "that is the region in no layer");
    }
    refuseSecond("layer", layer, scene_.layers);
    readSurface(reader, layer);
    if (const Node* content = reader.find("content")) {
      layer.content = material(*content, "'content'").name;
    }
    if (const Node* wall = reader.find("wall")) layer.wall = readWall(*wall);
    scene_.layers.push_back(std::move(layer));
  }
}

void RegionReader::requireRegion(const Node& node, bool globs) const {
  const std::vector<std::string_view> regions = regionNames(scene_);
  const std::string& name = node.text;
  if (isGlob(name)) {
    if (!globs) {
      throw loader_.document().error(node.mark, "scene.kind", "name one region here, not a pattern",
                                     "regions: " + listed(regions));
    }
    const bool matches = std::any_of(regions.begin(), regions.end(),
                                     [&](std::string_view r) { return matchesGlob(name, r); });
    if (!matches) {
      throw loader_.document().error(node.mark, "scene.unknown_region",
                                     "the glob " + inQuotes(name) + " matches no region",
                                     "regions: " + listed(regions));
    }
    return;
  }
  if (std::find(regions.begin(), regions.end(), name) == regions.end()) {
    throw unknownName(loader_.document(), node.mark, "region", name, regions);
  }
}

/// A region, a glob, or a list of these: separated by commas, which no name contains.
std::string RegionReader::readSide(const Node& node) const {
  const Document& document = loader_.document();
  if (node.kind != Node::Kind::kSequence) {
    const std::string name = readText(document, node, "a region");
    requireRegion(node, true);
    return name;
  }
  std::string names;
  for (const Node& item : readList(document, node, "a list of regions", 1, 0)) {
    const std::string name = readText(document, item, "a region");
    requireRegion(item, true);
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

RegionReader::Between RegionReader::readBetween(const MapReader& reader) const {
  const Document& document = loader_.document();
  const auto& items = readList(document, *reader.find("between"), "'between'", 2, 2);
  const Between between{readSide(items[0]), readSide(items[1])};
  // A list means every pair of its members.
  const bool is_one = between.a.find(',') == std::string::npos && !isGlob(between.a);
  if (between.a == between.b && is_one) {
    throw document.error(items[1].mark, "scene.kind",
                         "between " + inQuotes(between.a) + " and itself there is no wall");
  }
  return between;
}

void RegionReader::readWalls(const std::vector<MapReader>& walls) {
  const Document& document = loader_.document();
  for (const MapReader& reader : walls) {
    const Between between = readBetween(reader);
    WallOverride wall{
        between.a, between.b, readWall(*reader.find("wall")), {}, placeOf(reader, "between")};
    if (const Node* from = reader.find("felt_from")) {
      const std::size_t side = readChoice(document, *from, "'felt_from'", {between.a, between.b});
      wall.felt_from = side == 0 ? between.a : between.b;
      if (wall.wall.absent) {
        throw document.error(from->mark, "scene.kind",
                             "an absent wall cannot be limited to one side",
                             "for one way only, use a wall with a port that has a direction");
      }
    }
    scene_.walls.push_back(std::move(wall));
  }
}

void RegionReader::readStart(const MapReader& start) {
  scene_.start_region = start.text("region");
  requireRegion(*start.find("region"), false);
  scene_.start_place = placeOf(start, "region");
}

}  // namespace palpate
