#include "palpate/scene/scene_file.h"

#include <filesystem>

#include "scene/device_reader.h"
#include "scene/file_loader.h"
#include "scene/grids_reader.h"
#include "scene/material_reader.h"
#include "scene/messages.h"
#include "scene/paper_reader.h"
#include "scene/region_reader.h"
#include "scene/values.h"

namespace palpate {
std::string FileLoader::resolvePath(const std::string& path) const {
  const std::filesystem::path written(path);
  if (written.is_absolute()) return path;
  return (std::filesystem::path(document_.file).parent_path() / written).string();
}

std::shared_ptr<void> FileLoader::image(const std::string& name, Mark place) const {
  const auto found = images_.find(name);
  if (found != images_.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [known, image] : images_) names.push_back(known);
  throw unknownName(document_, place, "image", name, names);
}

MaterialMapPtr FileLoader::map(const Node& node, const ParameterKind& of) const {
  const std::string what = "the map of " + inQuotes(of.key);
  MapReader keys(*this, node, what);
  for (const auto& [kind, read] : registry_.maps) {
    if (!keys.has(kind)) continue;
    MapReader reader(*this, node, what, "map_of_" + kind);
    MaterialMapPtr map = read(reader, of);
    reader.finish();
    return map;
  }
  if (registry_.maps.empty()) {
    throw noReader(document_, node.mark, "maps of parameters");
  }
  for (const auto& [kind, read] : registry_.maps) (void)keys.optional(kind);
  keys.finish();
  throw document_.error(node.mark, "scene.missing_key", what + " is empty",
                        "write {grid: {file: NAME.vdb, name: LAYER/" + of.key + "}}");
}

// Read this before all else: a later format may change the meaning of everything below.
void FileLoader::readVersion(const Node& root) const {
  if (root.kind != Node::Kind::kMap) {
    throw document_.error(root.mark, "scene.kind", "a scene is a map of keys and values",
                          "it begins with palpate: 1");
  }
  for (const Node::Entry& entry : root.entries) {
    if (entry.key != "palpate") continue;
    refuseEmpty(document_, entry);
    const double version = readNumber(document_, entry.value, "'palpate'");
    if (entry.value.text != "1") {
      throw document_.error(entry.value.mark, "scene.version",
                            "the file is in scene format " + inQuotes(entry.value.text) +
                                "; this program reads format 1",
                            version > 1.0 ? "a newer program may read it" : "write palpate: 1");
    }
    return;
  }
  for (const Node::Entry& entry : root.entries) {
    if (suggest(entry.key, std::vector<std::string_view>{"palpate"}).empty()) continue;
    throw document_.error(entry.key_mark, "scene.unknown_key",
                          "unknown key " + inQuotes(entry.key) + " in a scene",
                          "did you mean 'palpate'?");
  }
  throw document_.error({1, 1}, "scene.version", "the file does not say that it is a scene",
                        "begin it with palpate: 1");
}

void FileLoader::readImages(const Node& images) {
  for (const Node::Entry& entry : images.entries) {
    refuseEmpty(document_, entry);
    if (!registry_.image) {
      throw noReader(document_, entry.key_mark, "images");
    }
    MapReader reader(*this, entry.value, "the image " + inQuotes(entry.key), "image");
    images_[entry.key] = registry_.image(reader);
    reader.finish();
  }
}

namespace {

ForceRequest readForce(const MapReader& reader) {
  ForceRequest force;
  if (reader.has("max")) force.max = reader.value("max");
  if (reader.has("slew")) force.slew = reader.value("slew");
  if (reader.has("ramp")) force.ramp = reader.value("ramp");
  return force;
}

}  // namespace

SceneDescription FileLoader::read() {
  readVersion(document_.root);
  SceneDescription scene;
  scene.file = document_.file;

  const MapReader top(*this, document_.root, "a scene", "scene");
  length_unit_ = top.text("length");
  meters_per_unit_ = *metersPer(length_unit_);
  scene.length_unit = length_unit_;
  scene.meters_per_unit = meters_per_unit_;
  scene.renderer = top.choice("renderer") == 0 ? RendererKind::kConstraint : RendererKind::kPaper;
  scene.keep_memory = top.choice("memory") == 1;
  if (const Node* images = top.find("images")) readImages(*images);
  if (const Node* materials = top.find("materials")) {
    scene.materials = readMaterials(*this, *materials);
  }
  if (const Node* fields = top.find("fields")) fields_.define(*fields);
  scene.fields = fields_.all();

  RegionReader regions(*this, registry_, fields_, scene);
  if (top.has("layers")) regions.readLayers(top.maps("layers"));
  if (top.has("walls")) regions.readWalls(top.maps("walls"));
  if (top.has("sheets")) regions.readSheets(top.maps("sheets"));
  if (top.has("ports")) regions.readPorts(top.maps("ports"));
  if (top.has("start")) regions.readStart(top.map("start"));
  if (top.has("device")) scene.device = readDevice(top.map("device"));
  if (top.has("force")) scene.force = readForce(top.map("force"));
  if (top.has("paper")) scene.paper = readPaper(top.map("paper"));
  if (top.has("grids")) readGrids(top.map("grids"), registry_, scene);
  return scene;
}

namespace {

SceneDescription sceneOf(const Document& document, const SceneRegistry& registry) {
  FileLoader loader(document, registry);
  return loader.read();
}

}  // namespace

SceneDescription parseScene(std::string_view text, const std::string& file,
                            const SceneRegistry& registry) {
  return sceneOf(*parseDocument(text, file), registry);
}

SceneDescription readScene(const std::string& path, const SceneRegistry& registry) {
  return sceneOf(*readDocument(path), registry);
}

}  // namespace palpate
