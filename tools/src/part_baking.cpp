#include "part_baking.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "input_kind.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/text.h"
#include "scene_baking.h"
#include "scene_text.h"

namespace palpate::tools {
namespace {

Node wordNode(std::string text) {
  Node node;
  node.kind = Node::Kind::kScalar;
  node.text = std::move(text);
  node.quoted = true;
  return node;
}

/// {baked: {field: `inside`, file: `grids`, name: LAYER/surface}}
Node recombinedNode(Node inside, std::string grids, const std::string& layer) {
  Node baked;
  baked.kind = Node::Kind::kMap;
  baked.entries.push_back({"field", {}, std::move(inside)});
  baked.entries.push_back({"file", {}, wordNode(std::move(grids))});
  baked.entries.push_back({"name", {}, wordNode(layer + "/surface")});
  Node kind;
  kind.kind = Node::Kind::kMap;
  kind.entries.push_back({"baked", {}, std::move(baked)});
  return kind;
}

Node* valueAt(Node& map, std::string_view key) {
  for (Node::Entry& entry : map.entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

/// The node at `layers: [{name: LAYER, inside: ...}]`; null if the layer has another kind of
/// surface.
Node* insideOf(Node& root, const std::string& layer) {
  Node* layers = valueAt(root, "layers");
  if (layers == nullptr) return nullptr;
  for (Node& node : layers->items) {
    const Node* name = node.find("name");
    if (name != nullptr && name->text == layer) return valueAt(node, "inside");
  }
  return nullptr;
}

bool hasGrid(const LayerParts& layer) {
  return std::any_of(layer.parts.begin(), layer.parts.end(),
                     [](const vdb::HybridPart& part) { return static_cast<bool>(part.grid); });
}

LayerParts partsOf(const LayerDescription& layer, const vdb::HybridOptions& bake,
                   Console& console) {
  const auto start = std::chrono::steady_clock::now();
  const Progress progress = console.progress();
  LayerParts out;
  out.layer = layer.name;
  out.parts = vdb::bakeHybrid(layer.inside->get(progress), bake, progress).parts;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const vdb::HybridPart& part : out.parts) {
    console.note("layer " + layer.name + (part.name.empty() ? "" : ", part " + part.name) + " " +
                 part.reason);
  }
  return out;
}

}  // namespace

BakedParts bakeParts(const BakeOptions& options, Console& console) {
  if (inputKind(options.input) != InputKind::kScene) {
    throw bakeUsageError("--parts applies to scenes");
  }
  const LoadedScene loaded(options.input, console, memoryLeft(options));
  const SceneDescription& description = loaded.description();
  checkSceneOptions(options, description);
  const LengthUnit unit = loaded.unit();
  const double asked = askedVoxel(options, unit);

  vdb::HybridOptions hybrid;
  hybrid.parts = vdb::Parts::kOperands;
  for (const PortDescription& port : description.ports) {
    if (port.on) hybrid.keep.push_back(port.on->get(console.progress()));
  }
  Node scene = withPathsSeenFrom(readDocument(options.input)->root, options.input, options.parts);
  const std::string grids =
      std::filesystem::absolute(options.output)
          .lexically_normal()
          .lexically_proximate(std::filesystem::absolute(options.parts).parent_path());
  BakedParts out;
  bool is_any = false;
  for (const LayerDescription& layer : description.layers) {
    if (!isAskedFor(options, layer.name)) continue;
    Node* inside = insideOf(scene, layer.name);
    if (inside == nullptr) {
      console.note("layer " + layer.name + " stays as it is: it is made of an image");
      continue;
    }
    double voxel = asked;
    if (!(voxel > 0.0)) {
      const FieldPtr field = layer.inside->get(console.progress());
      requireBounds(*field, layer.name, options.input);
      voxel = defaultVoxel(unit, field->bounds(), "layer " + layer.name, console);
    }
    hybrid.bake = gridOptions(options, layer.name, voxel, unit.name, options.input);
    out.layers.push_back(partsOf(layer, hybrid, console));
    if (!hasGrid(out.layers.back())) continue;
    is_any = true;
    *inside = recombinedNode(std::move(*inside), grids, layer.name);
  }
  if (!is_any) {
    throw Error(ErrorKind::kOperation,
                {"bake.no_parts", "no part of the scene gains from being a grid",
                 "use the scene as it is; the notes give the reasons", options.input});
  }
  out.scene = "# Made by `palpate bake --parts` from " + vdb::fileName(options.input) +
              ", with the grids of " + vdb::fileName(options.output) + ".\n" + sceneText(scene);
  return out;
}

}  // namespace palpate::tools
