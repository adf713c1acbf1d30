#include "scene/grids_reader.h"

#include <algorithm>

#include "scene/messages.h"
#include "scene/named_items.h"
#include "scene/values.h"

namespace palpate {
namespace {

std::vector<std::string> readKeep(MapReader& reader, const SceneDescription& scene) {
  std::vector<std::string> globs;
  const Node* keep = reader.optional("keep");
  if (keep == nullptr) return globs;
  const Document& document = reader.loader().document();
  const std::vector<std::string_view> names = namesOf(scene.layers);
  for (const Node& item : readList(document, *keep, "'keep'", 1, 0)) {
    const std::string glob = readText(document, item, "a layer");
    const bool matches = std::any_of(
        names.begin(), names.end(), [&](std::string_view name) { return matchesGlob(glob, name); });
    if (!matches) {
      throw document.error(item.mark, "scene.unknown_layer", "there is no layer " + inQuotes(glob),
                           suggestOrList(glob, names, "layers: "));
    }
    globs.push_back(glob);
  }
  return globs;
}

}  // namespace

void readGrids(const SceneLoader& loader, const SceneRegistry& registry, const Node& node,
               SceneDescription& scene) {
  MapReader reader(loader, node, "'grids'");
  SceneRegistry::GridChoice choice;
  choice.length_unit = loader.lengthUnit();
  choice.tolerance = reader.requireLength("tolerance");
  choice.voxel_size = reader.lengthOr("voxel", 0.0);
  for (const char* key : {"tolerance", "voxel"}) {
    const double value = std::string_view(key) == "voxel" ? choice.voxel_size : choice.tolerance;
    if (reader.has(key) && !(value > 0.0)) {
      throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be more than 0");
    }
  }
  const std::vector<std::string> keep = readKeep(reader, scene);
  reader.finish();
  if (!registry.choose_grids) {
    throw loader.document().error(node.mark, "scene.no_reader", "this program makes no grids",
                                  "palpate::vdb makes them, and is not part of this program");
  }
  for (const PortDescription& port : scene.ports) {
    if (port.on && port.on->isMade()) choice.keep.push_back(port.on->get());
  }
  for (LayerDescription& layer : scene.layers) {
    // What is a grid, or was asked to be, is so already.
    if (!layer.inside->isMade()) continue;
    if (std::any_of(keep.begin(), keep.end(),
                    [&](const std::string& glob) { return matchesGlob(glob, layer.name); })) {
      continue;
    }
    choice.layer = layer.name;
    choice.place = loader.document().place(node.mark);
    layer.inside = registry.choose_grids(layer.inside, choice);
  }
}

}  // namespace palpate
