#include "baking.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "input_kind.h"
#include "loaded_scene.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/scan_surface.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr double kDefaultVoxelsPerSide = 128.0;

using Clock = std::chrono::steady_clock;

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.bake", std::move(message), std::move(hint)});
}

/// Options that make no sense for this kind of input are refused, not ignored.
void refuse(bool given, const char* option, const char* applies_to) {
  if (given) throw usageError(std::string(option) + " applies to " + applies_to);
}

void refuseMeshOptions(const BakeOptions& options) {
  refuse(!options.sign.empty(), "--sign", "meshes");
  refuse(!options.shell.empty(), "--shell", "meshes");
}

/// --voxel [m], or 0 if it was not given. @throws Error (kUsage).
double askedVoxel(const BakeOptions& options, const LengthUnit& unit) {
  if (options.voxel.empty()) return 0.0;
  const double voxel = parseLength(options.voxel, unit, "--voxel");
  if (!(voxel > 0.0)) throw usageError("--voxel must be greater than 0");
  return voxel;
}

double defaultVoxel(const LengthUnit& unit, const Box3& bounds, const std::string& what,
                    Console& console) {
  const Vec3 size = bounds.size();
  const double voxel = std::max({size.x, size.y, size.z}) / kDefaultVoxelsPerSide;
  console.note(what + ": voxels of " + formatNumber(voxel / unit.metres, 3) + " " + unit.name +
               ", 1/128 of the longest side; --voxel says otherwise");
  return voxel;
}

vdb::BakeOptions bakeOptions(const BakeOptions& options, const std::string& layer, double voxel,
                             const std::string& unit, const std::string& source) {
  vdb::BakeOptions bake;
  bake.voxel_size = voxel;
  bake.half_width = options.half_width;
  bake.name = layer + "/surface";
  bake.length_unit = unit;
  bake.metadata = {{"layer", layer}, {"source", source}};
  return bake;
}

template <class Make>
BakedGrid timed(Make&& make) {
  const auto start = Clock::now();
  BakedGrid baked;
  baked.grid = make();
  baked.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return baked;
}

/// The description without what the layers asked for do not depend on. Labels of one image share it, so they
/// stay together; nothing is entered, so ports and walls go.
SceneDescription neededFor(const BakeOptions& options, SceneDescription description) {
  const auto wanted = [&](const LayerDescription& layer) {
    return options.layers.empty() || std::find(options.layers.begin(), options.layers.end(),
                                               layer.name) != options.layers.end();
  };
  std::set<std::string> groups;
  for (const auto& layer : description.layers) {
    if (wanted(layer) && !layer.label_group.empty()) groups.insert(layer.label_group);
  }
  std::erase_if(description.layers, [&](const LayerDescription& layer) {
    return !wanted(layer) && !groups.contains(layer.label_group);
  });
  description.ports.clear();
  description.walls.clear();
  description.start_region = "outside";
  return description;
}

std::vector<BakedGrid> bakeScene(const BakeOptions& options, Console& console) {
  refuse(!options.units.empty(), "--units", "meshes; a scene names its unit");
  refuseMeshOptions(options);
  refuse(options.above.has_value(), "--above", "images");
  refuse(!options.labels.empty(), "--labels", "images");
  LoadedScene loaded(options.input, console);
  const SceneDescription& description = loaded.description();
  std::vector<std::string_view> names;
  for (const auto& layer : description.layers) names.push_back(layer.name);
  for (const std::string& wanted : options.layers) {
    if (std::find(names.begin(), names.end(), wanted) != names.end()) continue;
    const std::string close = suggest(wanted, names);
    throw inputError(
        "scene.unknown_layer", "there is no layer '" + wanted + "'",
        close.empty() ? "palpate info names the layers" : "did you mean '" + close + "'?",
        options.input);
  }
  const LengthUnit unit = loaded.unit();
  const double asked = askedVoxel(options, unit);
  const ScenePtr scene = palpate::compile(neededFor(options, description), console.progress());
  std::vector<BakedGrid> grids;
  for (const Region& region : scene->regions()) {
    if (!region.field) continue;
    if (!options.layers.empty() && std::find(options.layers.begin(), options.layers.end(),
                                             region.name) == options.layers.end()) {
      continue;
    }
    if (!region.field->bounds().isBounded()) {
      throw inputError("bake.unbounded", "layer '" + region.name + "' reaches to infinity",
                       "bake the others with --layer, or cut it in the scene: inside: "
                       "{intersection: [it, a box]}",
                       options.input);
    }
    const std::string source =
        region.source.empty() ? options.input : options.input + ": " + region.source;
    grids.push_back(timed([&] {
      // What comes from a grid has a voxel size already.
      const double voxel = asked > 0.0              ? asked
                           : !region.source.empty() ? region.field->featureSize()
                                                    : defaultVoxel(unit, region.field->bounds(),
                                                                   "layer " + region.name, console);
      return vdb::bake(*region.field, bakeOptions(options, region.name, voxel, unit.name, source),
                       console.progress());
    }));
  }
  return grids;
}

std::string onlyLayerName(const BakeOptions& options) {
  if (options.layers.size() > 1)
    throw usageError("one surface has one name; --layer was given twice");
  return options.layers.empty() ? stemOf(options.input) : options.layers.front();
}

std::vector<BakedGrid> bakeMeshFile(const BakeOptions& options, Console& console) {
  refuse(options.above.has_value(), "--above", "images");
  refuse(!options.labels.empty(), "--labels", "images");
  const std::string layer = onlyLayerName(options);
  if (options.units.empty()) {
    console.note(options.input + ": one unit is taken as 1 mm; --units says otherwise");
  }
  const LengthUnit unit = lengthUnit(options.units.empty() ? "mm" : options.units);
  const double asked = askedVoxel(options, unit);
  const vdb::MeshSign sign = options.sign == "winding" ? vdb::MeshSign::kWinding
                             : options.sign == "flood" ? vdb::MeshSign::kFlood
                                                       : vdb::MeshSign::kVote;
  const double shell = options.shell.empty() ? 0.0 : parseLength(options.shell, unit, "--shell");
  if (!options.shell.empty() && !(shell > 0.0)) {
    throw usageError("--shell must be greater than 0");
  }
  const vdb::Mesh mesh = vdb::readMesh(options.input, unit.metres);
  Box3 bounds;
  for (const Vec3& v : mesh.vertices) bounds.include(v);
  return {timed([&] {
    const double voxel = asked > 0.0 ? asked : defaultVoxel(unit, bounds, options.input, console);
    vdb::BakeOptions bake = bakeOptions(options, layer, voxel, unit.name, options.input);
    bake.mesh_sign = sign;
    bake.shell_thickness = shell;
    return vdb::bakeMesh(mesh, bake, console.progress());
  })};
}

/// The labels asked for, as layers: a name for each set of values, in the order asked.
std::vector<std::pair<std::string, std::vector<int>>> labelLayers(const BakeOptions& options) {
  const vdb::NameTable names =
      options.names.empty() ? vdb::NameTable{} : vdb::readNameTable(options.names);
  std::vector<std::pair<std::string, std::vector<int>>> layers;
  for (const std::string& entry : options.labels) {
    for (const int value : vdb::resolveLabels({entry}, names, options.names)) {
      const auto named = names.find(value);
      const std::string layer =
          named != names.end() ? named->second : "label_" + std::to_string(value);
      auto at = std::find_if(layers.begin(), layers.end(),
                             [&](const auto& l) { return l.first == layer; });
      if (at == layers.end()) at = layers.insert(layers.end(), {layer, {}});
      if (std::find(at->second.begin(), at->second.end(), value) == at->second.end()) {
        at->second.push_back(value);
      }
    }
  }
  return layers;
}

std::vector<BakedGrid> bakeImage(const BakeOptions& options, Console& console) {
  refuse(!options.units.empty(), "--units", "meshes; an image says where its voxels are");
  refuseMeshOptions(options);
  if (options.above.has_value() == !options.labels.empty()) {
    throw usageError(options.labels.empty() ? "an image needs --above VALUE or --labels NAME,..."
                                            : "--above and --labels exclude one another");
  }
  refuse(!options.labels.empty() && !options.keep.empty(), "--keep", "--above");
  refuse(!options.labels.empty() && options.fill, "--fill", "--above");
  refuse(options.labels.empty() && !options.names.empty(), "--names", "--labels");
  refuse(!options.labels.empty() && !options.layers.empty(), "--layer",
         "--above; labels are called by their names");
  const LengthUnit mm = {"mm", 1e-3};
  const double asked = askedVoxel(options, mm);
  const auto layers = labelLayers(options);

  const vdb::Image image = vdb::readNifti(options.input);
  for (const auto& note : image.notes) console.note(options.input + ": " + note);
  const double spacing = std::min(
      {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])});
  const double voxel = asked > 0.0 ? asked : spacing;

  std::vector<BakedGrid> grids;
  if (options.above) {
    vdb::ThresholdOptions threshold;
    threshold.above = *options.above;
    threshold.largest_component = options.keep != "all";
    threshold.fill = options.fill;
    threshold.voxel_size = asked;
    grids.push_back(timed([&] {
      return vdb::surfaceFromThreshold(
          image, threshold,
          bakeOptions(options, onlyLayerName(options), voxel, "mm", options.input),
          console.progress());
    }));
    return grids;
  }
  std::vector<std::vector<int>> values;
  for (const auto& layer : layers) values.push_back(layer.second);
  vdb::LabelSurfaces surfaces(image, values);
  for (std::size_t n = 0; n < layers.size(); ++n) {
    grids.push_back(timed([&] {
      return surfaces.surface(n, asked,
                              bakeOptions(options, layers[n].first, voxel, "mm", options.input),
                              console.progress());
    }));
  }
  return grids;
}

}  // namespace

std::vector<BakedGrid> bakeInput(const BakeOptions& options, Console& console) {
  switch (inputKind(options.input)) {
    case InputKind::kScene:
      return bakeScene(options, console);
    case InputKind::kMesh:
      return bakeMeshFile(options, console);
    case InputKind::kImage:
      return bakeImage(options, console);
    case InputKind::kGrid:
      break;
  }
  throw inputError("bake.kind", "this is a grid already", "bake a scene, a mesh or an image",
                   options.input);
}

}  // namespace palpate::tools
