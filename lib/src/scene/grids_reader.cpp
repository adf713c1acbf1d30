#include "scene/grids_reader.h"

#include <algorithm>

#include "scene/messages.h"
#include "scene/named_items.h"

namespace palpate {
namespace {

std::vector<std::string> readKeep(const MapReader& reader, const SceneDescription& scene) {
  std::vector<std::string> globs;
  const Node* keep = reader.find("keep");
  if (keep == nullptr) return globs;
  const std::vector<std::string_view> names = namesOf(scene.layers);
  for (const Node& item : keep->items) {
    const bool matches = std::any_of(names.begin(), names.end(), [&](std::string_view name) {
      return matchesGlob(item.text, name);
    });
    if (!matches) {
      throw reader.loader().document().error(item.mark, "scene.unknown_layer",
                                             "there is no layer " + inQuotes(item.text),
                                             suggestOrList(item.text, names, "layers: "));
    }
    globs.push_back(item.text);
  }
  return globs;
}

}  // namespace

void readGrids(const MapReader& reader, const SceneRegistry& registry, SceneDescription& scene) {
  const Document& document = reader.loader().document();
  SceneRegistry::GridChoice choice;
  choice.length_unit = reader.loader().lengthUnit();
  choice.tolerance = reader.value("tolerance");
  choice.voxel_size = reader.value("voxel");
  choice.place = document.place(reader.node().mark);
  const std::vector<std::string> keep = readKeep(reader, scene);
  if (!registry.choose_grids) {
    throw document.error(reader.node().mark, "scene.no_reader", "this program cannot make grids",
                         "palpate::vdb makes them, and is not part of this program");
  }
  for (const PortDescription& port : scene.ports) {
    if (port.on && port.on->isMade()) choice.keep.push_back(port.on->get());
  }
  for (LayerDescription& layer : scene.layers) {
    // A field that is already made is a grid, or was asked to be one.
    if (!layer.inside->isMade()) continue;
    if (std::any_of(keep.begin(), keep.end(),
                    [&](const std::string& glob) { return matchesGlob(glob, layer.name); })) {
      continue;
    }
    choice.layer = layer.name;
    layer.inside = registry.choose_grids(layer.inside, choice);
  }
}

}  // namespace palpate
