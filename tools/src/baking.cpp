#include "baking.h"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <optional>
#include <set>

#include "grid_baking.h"
#include "input_kind.h"
#include "label_range.h"
#include "loaded_scene.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/image_distances.h"
#include "palpate/vdb/label_survey.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/scan_surface.h"
#include "scan_options.h"
#include "scene_baking.h"
#include "scene_parameters.h"
#include "text.h"

namespace palpate::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Refuses options that make no sense for this kind of input, instead of ignoring them.
void refuse(bool given, const char* option, const char* applies_to) {
  if (given) throw bakeUsageError(std::string(option) + " applies to " + applies_to);
}

void refuseMeshOptions(const BakeOptions& options) {
  refuse(!options.sign.empty(), "--sign", "meshes");
  refuse(!options.shell.empty(), "--shell", "meshes");
  refuse(options.smooth.has_value(), "--smooth", "meshes");
}

/// [bytes] Memory of these grids.
std::uint64_t memoryOf(const std::vector<BakedGrid>& grids) {
  std::uint64_t memory = 0;
  for (const BakedGrid& one : grids) memory += one.grid.info().memory;
  return memory;
}

template <class Make>
BakedGrid timed(Make&& make) {
  const auto start = Clock::now();
  BakedGrid baked;
  baked.grid = make();
  baked.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return baked;
}

/// The description without the parts that the requested layers do not depend on. Layers of labels
/// that share an image stay together. A bake needs no ports and walls, which are removed.
SceneDescription neededFor(const BakeOptions& options, SceneDescription description) {
  std::set<std::string> groups;
  for (const auto& layer : description.layers) {
    if (isAskedFor(options, layer.name) && !layer.label_group.empty())
      groups.insert(layer.label_group);
  }
  std::erase_if(description.layers, [&](const LayerDescription& layer) {
    return !isAskedFor(options, layer.name) && !groups.contains(layer.label_group);
  });
  description.ports.clear();
  description.walls.clear();
  description.start_region = "outside";
  return description;
}

/// Adds the maps of the requested layers, and, if all layers are requested, of the ports.
void addMaterials(const BakeOptions& options, const SceneDescription& description,
                  std::vector<vdb::NamedMaterialGrid>& materials) {
  for (const SceneParameter& found : sceneParameters(description)) {
    const vdb::MaterialGridPtr grid = found.grid();
    if (!grid || !isAskedFor(options, found.owner)) continue;
    materials.push_back({found.name(),
                         grid,
                         found.unit,
                         description.length_unit,
                         {{"layer", found.owner},
                          {"parameter", found.parameter},
                          {"source", options.input + ": " + grid->info().source}}});
  }
}

std::vector<BakedGrid> bakeScene(const BakeOptions& options, Console& console,
                                 std::vector<vdb::NamedMaterialGrid>* materials) {
  LoadedScene loaded(options.input, console, memoryLeft(options));
  const SceneDescription& description = loaded.description();
  checkSceneOptions(options, description);
  refuseScanOptions(options.scan, false);
  if (materials != nullptr) addMaterials(options, description, *materials);
  const LengthUnit unit = loaded.unit();
  const double asked = askedVoxel(options, unit);
  const ScenePtr scene = palpate::compile(neededFor(options, description), console.progress());
  std::vector<BakedGrid> grids;
  for (const Region& region : scene->regions()) {
    if (!region.field || !isAskedFor(options, region.name)) continue;
    requireBounds(*region.field, region.name, options.input);
    const std::string source =
        region.source.empty() ? options.input : options.input + ": " + region.source;
    grids.push_back(timed([&] {
      // A field that comes from a grid has a voxel size already.
      const double voxel = asked > 0.0              ? asked
                           : !region.source.empty() ? region.field->featureSize()
                                                    : defaultVoxel(unit, region.field->bounds(),
                                                                   "layer " + region.name, console);
      return vdb::bake(*region.field,
                       gridOptions(options, region.name, voxel, unit.name, source, memoryOf(grids)),
                       console.progress());
    }));
    if (region.source.empty()) grids.back().analytic = region.field;
  }
  return grids;
}

std::string onlyLayerName(const BakeOptions& options) {
  if (options.layers.size() > 1)
    throw bakeUsageError("--layer was given twice; one surface has one name");
  return options.layers.empty() ? stemOf(options.input) : options.layers.front();
}

std::vector<BakedGrid> bakeMeshFile(const BakeOptions& options, Console& console) {
  refuse(options.above.has_value(), "--above", "images");
  refuse(options.distances, "--distances", "images");
  refuse(!options.labels.empty(), "--labels", "images");
  const std::string layer = onlyLayerName(options);
  const LengthUnit unit = meshUnit(options.units);
  const double asked = askedVoxel(options, unit);
  const vdb::MeshSign sign = options.sign == "winding"    ? vdb::MeshSign::kWinding
                             : options.sign == "flood"    ? vdb::MeshSign::kFlood
                             : options.sign == "unsigned" ? vdb::MeshSign::kUnsigned
                                                          : vdb::MeshSign::kVote;
  const double shell = options.shell.empty() ? 0.0 : parseLength(options.shell, unit, "--shell");
  if (!options.shell.empty() && !(shell > 0.0)) {
    throw bakeUsageError("--shell must be greater than 0");
  }
  if (shell > 0.0 && sign == vdb::MeshSign::kUnsigned) {
    throw bakeUsageError("--shell and --sign unsigned exclude one another");
  }
  const vdb::Mesh mesh = readMeshFile(options.input, options.units, options.scan, console);
  Box3 bounds;
  for (const Vec3& v : mesh.vertices) bounds.include(v);
  return {timed([&] {
    const double voxel = asked > 0.0 ? asked : defaultVoxel(unit, bounds, options.input, console);
    vdb::BakeOptions bake = gridOptions(options, layer, voxel, unit.name, options.input);
    bake.mesh_sign = sign;
    bake.shell_thickness = shell;
    bake.smooth_angle = options.smooth.value_or(0.0) * std::numbers::pi / 180.0;
    return vdb::bakeMesh(mesh, bake, console.progress());
  })};
}

/// The labels that an entry means: 7, a name, a pattern, or those of a range 5-28 that the image
/// holds.
std::vector<int> labelsIn(const std::string& entry, const vdb::NameTable& names,
                          const std::string& source, const vdb::Image& image) {
  const bool is_range = entry.find('-') != std::string::npos;
  const auto range = is_range ? labelRange(entry) : std::nullopt;
  if (!range) return vdb::resolveLabels({entry}, names, source);
  std::vector<int> values;
  for (const auto& [label, voxels] : vdb::countLabels(image)) {
    if (label != 0 && label >= range->first && label <= range->second) values.push_back(label);
  }
  if (values.empty()) {
    throw inputError("labels.no_voxels", "no voxel of the image has any of the labels " + entry,
                     "palpate info lists the labels", source);
  }
  return values;
}

/// The requested labels as layers: a name for each set of values, in the order of the request.
std::vector<std::pair<std::string, std::vector<int>>> labelLayers(const BakeOptions& options,
                                                                  const vdb::Image& image) {
  const bool is_grid = inputKind(options.input) == InputKind::kGrid;
  const vdb::NameTable names =
      !options.names.empty() ? vdb::readLabelTable(options.names).names
      : is_grid              ? vdb::NameTable{}
                : vdb::readImageInfo(options.input, imageOptions(options.scan)).labels.names;
  const std::string source = options.names.empty() ? options.input : options.names;
  std::vector<std::pair<std::string, std::vector<int>>> layers;
  for (const std::string& entry : options.labels) {
    for (const int value : labelsIn(entry, names, source, image)) {
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

/// Reports the parts of the scan that the grid could not hold.
void tellLoss(const BakeOptions& options, const vdb::LevelSet& grid, Console& console) {
  const std::string note = vdb::scanLossNote(grid.info());
  if (!note.empty()) console.note(options.input + ": " + grid.info().name + ": " + note);
}

/// Checks that the values of `image` are distances in mm. @throws Error if nothing is inside, or
/// everything.
void checkDistances(const BakeOptions& options, const vdb::Image& image, Console& console) {
  const std::optional<double> slope = vdb::slopeAtZero(image);
  if (!slope) {
    throw inputError(
        "image.distances",
        "the values nowhere change from negative to positive, so there is no surface at 0",
        "signed distances are negative inside; for gray values give --above VALUE", options.input);
  }
  if (!vdb::looksLikeDistances(image)) {
    console.note(options.input + ": at its surface the values change by " +
                 formatNumber(*slope * 1e-3, 3) +
                 " per mm instead of 1, so they are not distances in mm; only the place where they "
                 "are 0 is used");
  }
}

/// Warns that in an image of distances --above takes the outside for the inside.
void tellDistances(const BakeOptions& options, const vdb::Image& image, Console& console) {
  const std::string note = vdb::distancesNote(image);
  if (!note.empty()) console.note(options.input + ": " + note + "; --distances takes the inside");
}

std::vector<BakedGrid> bakeImage(const BakeOptions& options, Console& console) {
  const bool is_grid = inputKind(options.input) == InputKind::kGrid;
  refuse(!options.units.empty() && !is_grid, "--units",
         "meshes; an image says where its voxels are");
  refuseMeshOptions(options);
  const int asked_for =
      (options.above ? 1 : 0) + (options.labels.empty() ? 0 : 1) + (options.distances ? 1 : 0);
  if (asked_for != 1) {
    throw bakeUsageError(asked_for == 0
                             ? "an image needs --above VALUE, --labels NAME,... or --distances"
                             : "--above, --labels and --distances exclude one another");
  }
  refuse(options.distances && is_grid, "--distances", "images; a grid of them: --level-set");
  refuse(options.distances && !options.keep.empty(), "--keep", "--above");
  refuse(options.distances && options.fill, "--fill", "--above");
  refuse(!options.labels.empty() && !options.keep.empty(), "--keep", "--above");
  refuse(!options.labels.empty() && options.fill, "--fill", "--above");
  refuse(options.labels.empty() && !options.names.empty(), "--names", "--labels");
  refuse(!options.labels.empty() && !options.layers.empty() && !is_grid, "--layer",
         "--above; labels are called by their names");
  if (is_grid) refuseScanOptions(options.scan, false);
  std::string unit;
  const vdb::Image image = readVoxels(options, unit);
  const auto layers = labelLayers(options, image);
  const double asked = askedVoxel(options, lengthUnit(unit));
  for (const auto& note : image.notes) console.note(options.input + ": " + note);
  const double spacing = std::min(
      {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])});
  const double voxel = asked > 0.0 ? asked : spacing;

  std::vector<BakedGrid> grids;
  if (options.above || options.distances) {
    if (options.distances) checkDistances(options, image, console);
    if (options.above) tellDistances(options, image, console);
    vdb::ThresholdOptions threshold;
    threshold.above = options.above.value_or(0.0);
    if (options.distances) threshold.below = 0.0;
    threshold.largest_component = !options.distances && options.keep != "all";
    threshold.fill = options.fill;
    threshold.voxel_size = asked;
    grids.push_back(timed([&] {
      return vdb::surfaceFromThreshold(
          image, threshold,
          gridOptions(options, onlyLayerName(options), voxel, unit, options.input),
          console.progress());
    }));
    tellLoss(options, grids.back().grid, console);
    return grids;
  }
  std::vector<std::vector<int>> values;
  for (const auto& layer : layers) values.push_back(layer.second);
  vdb::LabelSurfaces surfaces(image, values);
  for (std::size_t n = 0; n < layers.size(); ++n) {
    grids.push_back(timed([&] {
      return surfaces.surface(
          n, asked,
          gridOptions(options, layers[n].first, voxel, unit, options.input, memoryOf(grids)),
          console.progress());
    }));
    tellLoss(options, grids.back().grid, console);
  }
  if (layers.size() < 2) return grids;
  // Where labels meet, only the grid of all labels together shows which points are in none of them.
  vdb::BakeOptions whole =
      gridOptions(options, "united", voxel, unit, options.input, memoryOf(grids));
  whole.name = kUnitedGrid;
  std::optional<vdb::LevelSet> united;
  BakedGrid last = timed([&] {
    united = surfaces.united(asked, whole, console.progress());
    return united.value_or(vdb::LevelSet());
  });
  if (united) grids.push_back(std::move(last));
  return grids;
}

std::vector<BakedGrid> baked(const BakeOptions& options, Console& console,
                             std::vector<vdb::NamedMaterialGrid>* materials) {
  switch (inputKind(options.input)) {
    case InputKind::kScene:
      return bakeScene(options, console, materials);
    case InputKind::kMesh:
      return bakeMeshFile(options, console);
    case InputKind::kImage:
      return bakeImage(options, console);
    case InputKind::kGrid:
      refuseMeshOptions(options);
      refuseScanOptions(options.scan, false);
      return inTheSameFrame(options, options.above || options.distances || !options.labels.empty()
                                         ? bakeImage(options, console)
                                         : std::vector<BakedGrid>{rebakeGrid(options, console)});
  }
  return {};
}

}  // namespace

std::vector<BakedGrid> bakeInput(const BakeOptions& options, Console& console,
                                 std::vector<vdb::NamedMaterialGrid>* materials) try {
  std::vector<BakedGrid> grids = baked(options, console, materials);
  for (const BakedGrid& one : grids) {
    const vdb::LevelSetInfo& info = one.grid.info();
    const auto lost = info.metadata.find("lost_parts");
    if (lost != info.metadata.end()) {
      console.note(info.name + " lacks parts that its voxels cannot hold: " + lost->second);
    }
  }
  return grids;
} catch (const Error& error) {
  throw withMemoryHint(error);
}

}  // namespace palpate::tools
