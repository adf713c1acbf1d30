#include "palpate/vdb/register.h"

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <utility>

#include "bake/solid.h"
#include "lazy_field.h"
#include "palpate/core/text.h"
#include "palpate/scene/units.h"
#include "palpate/scene/vocabulary.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/image_distances.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/scan_surface.h"
#include "palpate/vdb/text.h"
#include "scene_baked.h"
#include "scene_grid.h"
#include "scene_image.h"
#include "scene_map.h"
#include "scene_mask.h"
#include "voxel_box.h"

namespace palpate::vdb {
namespace {

/// Options for a grid that this module made itself.
CertifyOptions madeHere() {
  CertifyOptions options;
  options.is_foreign = false;
  return options;
}

/// Raise this whenever baking the same source gives another grid: grids that were kept before are
/// then made again. A test shows when.
constexpr int kBakerVersion = 2;

ContentKey beginKey(const char* kind) {
  ContentKey key;
  key.add("palpate grid").add(kBakerVersion).add(kind);
  return key;
}

/// Adds everything that affects a grid, except its name.
void addHow(ContentKey& key, const BakeOptions& bake, Sampler sampler) {
  key.add(bake.voxel_size).add(bake.half_width).add(bake.length_unit);
  key.add(static_cast<int>(bake.mesh_sign)).add(bake.shell_thickness).add(bake.smooth_angle);
  key.add(static_cast<int>(sampler));
}

/// Reads how a mesh becomes a solid.
void readMeshKeys(const MapReader& reader, BakeOptions& bake) {
  constexpr MeshSign kSigns[] = {MeshSign::kVote, MeshSign::kWinding, MeshSign::kFlood};
  bake.mesh_sign = kSigns[reader.choice("sign")];
  bake.shell_thickness = reader.value("shell");
  bake.smooth_angle = reader.value("smooth") * std::numbers::pi / 180.0;
}

Box3 boxOf(const Mesh& mesh) {
  Box3 box;
  for (const Vec3& vertex : mesh.vertices) box.include(vertex);
  return box;
}

/// Whether edges of a mesh of flat faces stay sharp: they do unless the scene asks for a grid.
bool readEdges(const MapReader& reader) {
  if (reader.has("edges")) return reader.choice("edges") == 0;
  constexpr const char* kOfGrids[] = {"voxel", "half_width", "sampler", "shell", "smooth"};
  return std::none_of(std::begin(kOfGrids), std::end(kOfGrids),
                      [&](const char* key) { return reader.has(key); });
}

/// [rad] The angle at `sharp`; 0 if it is not given.
double readSharp(const MapReader& reader) {
  for (const std::string& key : reader.words("sharp").excludes) {
    if (!reader.has("sharp") || !reader.has(key)) continue;
    throw reader.errorAt("sharp", "scene.kind", "'sharp' and '" + key + "' exclude one another",
                         "sharp edges are those of the triangles as they are");
  }
  return reader.value("sharp") * std::numbers::pi / 180.0;
}

FieldSourcePtr meshField(const CommonPtr& common, const MapReader& reader) {
  const std::string path = readExistingFile(reader, "file");
  const bool is_sharp = readEdges(reader);
  const double sharp_angle = readSharp(reader);
  BakeOptions bake;
  bake.max_memory = common->options.max_memory;
  bake.length_unit = reader.loader().lengthUnit();
  const std::string prescribed = prescribedUnit(path);
  const double meters = *metersPer(reader.has("units")  ? reader.text("units")
                                   : prescribed.empty() ? bake.length_unit
                                                        : prescribed);
  bake.voxel_size = reader.value("voxel");
  bake.half_width = reader.value("half_width");
  readMeshKeys(reader, bake);
  const Space space = readSpace(reader);
  bake.metadata["source"] = path;
  const Sampler sampler = readSampler(reader);
  const auto read = [common, path, meters, space](const Progress& progress) {
    report(progress, "read", 0.0);
    Mesh mesh = readMesh(path, meters, space);
    if (mesh.space_is_stated && mesh.space == Space::kLps) {
      common->notes->add(path, {"coordinates are LPS, as the file says: x and y are negated"});
    }
    return mesh;
  };
  MeshWays ways;
  if (sharp_angle > 0.0) {
    ways.finish = [common, path, read, sharp_angle](FieldPtr baked, const LevelSet& grid) {
      SharpField made =
          withSharpEdges(std::move(baked), read({}), sharp_angle, grid.info().voxel_size);
      if (made.left_to_grid > 0) {
        common->notes->add(
            path, {std::to_string(made.left_to_grid) + " of " + std::to_string(made.edges) +
                   " sharp edges are rounded as in a grid, because parts overlap beside them (for "
                   "example at " +
                   eachInMillimeters(made.place) +
                   "); join the parts into one solid to keep them sharp"});
      }
      return std::move(made.field);
    };
  }
  if (is_sharp && bake.shell_thickness == 0.0 && bake.smooth_angle == 0.0) {
    ways.instead = [common, path, read](const Progress& progress) {
      FieldPtr solid = polyhedronField(read(progress));
      if (solid) {
        common->notes->add(path, {"its faces are flat and few: they are felt as they are, with "
                                  "sharp edges; edges: rounded makes a grid"});
      }
      return solid;
    };
  }
  GridSource source;
  source.what = fileName(path);
  source.summary = "mesh " + fileName(path);
  source.place = reader.loader().document().place(reader.node().mark);
  source.sampler = sampler;
  source.make = [read, bake](const Progress& progress) {
    const Mesh mesh = read(progress);
    BakeOptions options = bake;
    if (!(options.voxel_size > 0.0)) {
      const Vec3 size = checkMesh(mesh).bounds.size();
      options.voxel_size = std::max({size.x, size.y, size.z}) / 128.0;
    }
    return bakeMesh(mesh, options, progress);
  };
  source.measure = [path, meters, space, shell = bake.shell_thickness](const Progress&) {
    return boxOf(readMesh(path, meters, space)).grownBy(shell);
  };
  source.ways = std::move(ways);
  source.certify = madeHere();
  // The key depends on the mesh as it was read, whatever files it comes from and whatever their
  // unit.
  source.content = [path, read, bake, sampler](const Progress& progress) {
    GridContent content;
    content.files = SourceState(meshFiles(path));
    const Mesh mesh = read(progress);
    content.grid = beginKey("mesh");
    content.grid.add(mesh.vertices.size())
        .addBytes(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3))
        .addBytes(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
    addHow(content.grid, bake, sampler);
    content.box = content.grid;
    content.box.add("box");
    return content;
  };
  source.name = bake.name;
  source.metadata = bake.metadata;
  source.file = path;
  return lazyField(common, std::move(source));
}

FieldSourcePtr gridFileField(const CommonPtr& common, const MapReader& reader) {
  const std::string path = readExistingFile(reader, "file");
  const std::string name = reader.text("name");
  const std::string unit = reader.text("units");
  const auto unknown = reader.has("class") ? UnknownClass::kLevelSet : UnknownClass::kRefuse;
  GridSource source;
  source.what = fileName(path);
  source.summary = "grid " + fileName(path);
  source.place = reader.loader().document().place(reader.node().mark);
  source.sampler = readSampler(reader);
  source.make = [path, name, unit, unknown,
                 limit = common->options.max_memory](const Progress& progress) {
    report(progress, "read", 0.0);
    return readVdb(path, name, unit, unknown, limit);
  };
  source.measure = [path, name, unit, unknown,
                    limit = common->options.max_memory](const Progress&) {
    return readVdb(path, name, unit, unknown, limit).info().bounds;
  };
  source.certify.path = path;
  return lazyField(common, std::move(source));
}

FieldSourcePtr maskField(const CommonPtr& common, const MapReader& reader) {
  MaskOptions mask;
  mask.file = readExistingFile(reader, "file");
  mask.name = reader.text("name");
  mask.unit_if_missing = reader.text("units");
  if (reader.has("above")) mask.above = reader.value("above");
  mask.voxel_size = reader.value("voxel");
  BakeOptions bake;
  bake.max_memory = common->options.max_memory;
  bake.length_unit = reader.loader().lengthUnit();
  bake.metadata["source"] = mask.file;
  const Sampler sampler = readSampler(reader);
  GridSource source;
  source.what = fileName(mask.file);
  source.summary = "mask " + fileName(mask.file);
  source.place = reader.loader().document().place(reader.node().mark);
  source.sampler = sampler;
  source.make = [mask, bake](const Progress& progress) {
    report(progress, "read", 0.0);
    return surfaceOfMask(mask, bake, progress);
  };
  source.measure = [mask](const Progress&) {
    return boxWhere(readVdbImage(mask.file, mask.name, mask.unit_if_missing),
                    [](float value) { return value != 0.0F; });
  };
  source.certify = madeHere();
  source.content = [mask, bake, sampler](const Progress&) {
    GridContent content;
    content.grid = beginKey("mask");
    content.files = SourceState({mask.file}, content.grid);
    content.grid.add(mask.name).add(mask.unit_if_missing);
    content.box = content.grid;
    content.box.add("box");
    content.grid.add(mask.above.has_value()).add(mask.above.value_or(0.0)).add(mask.voxel_size);
    addHow(content.grid, bake, sampler);
    return content;
  };
  source.name = bake.name;
  source.metadata = bake.metadata;
  source.file = mask.file;
  return lazyField(common, std::move(source));
}

/// The image that a layer names, and the name of the layer's grid.
struct LayerImage {
  std::string name;
  std::shared_ptr<SceneImage> image;
  BakeOptions bake;
  SourcePlace place;
  Sampler sampler;

  LayerImage(const MapReader& reader, const std::string& layer, std::uint64_t max_memory)
      : name(reader.text("image")),
        image(std::static_pointer_cast<SceneImage>(
            reader.loader().image(name, reader.find("image")->mark))),
        place(reader.loader().document().place(reader.node().mark)),
        sampler(readSampler(reader)) {
    bake.max_memory = max_memory;
    bake.name = layer + "/surface";
    bake.length_unit = reader.loader().lengthUnit();
    bake.metadata["layer"] = layer;
  }

  /// The parts of a GridSource that all layers of images share.
  [[nodiscard]] GridSource source(const std::string& layer, std::string summary) const {
    GridSource out;
    out.what = layer;
    out.summary = std::move(summary);
    out.place = place;
    out.sampler = sampler;
    out.certify = madeHere();
    out.name = bake.name;
    out.metadata = bake.metadata;
    out.metadata["source"] = image->file->path();
    out.file = image->file->path();
    return out;
  }

  /// The content key of the image's files and `kind`.
  [[nodiscard]] static GridContent content(ImageFile& file, const char* kind) {
    GridContent out;
    out.files = file.state();
    out.grid = beginKey(kind);
    out.grid.add(file.contentKey());
    return out;
  }
};

std::vector<int> readMatch(const MapReader& reader, const SceneImage& image) {
  const Node& list = *reader.find("match");
  const Document& document = reader.loader().document();
  if (list.kind != Node::Kind::kSequence || list.items.empty()) {
    throw reader.errorAt("match", "scene.kind", "'match' must be a list of label names or values",
                         "write match: [liver], match: [\"rib_*\", 12]");
  }
  std::vector<int> values;
  for (const Node& item : list.items) {
    if (item.kind != Node::Kind::kScalar) {
      throw document.error(item.mark, "scene.kind", "a label is a name or a value");
    }
    try {
      const std::vector<int> found =
          resolveLabels({item.text}, image.labels.names, image.names_path);
      values.insert(values.end(), found.begin(), found.end());
    } catch (const Error& error) {
      const Problem& problem = error.problem();
      throw document.error(item.mark, problem.code,
                           (problem.file.empty() ? "" : problem.file + ": ") + problem.message,
                           problem.hint);
    }
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

SceneRegistry::LayerSurface labelsLayer(const CommonPtr& common, const MapReader& reader,
                                        const std::string& layer) {
  const LayerImage from(reader, layer, common->options.max_memory);
  const std::vector<int> values = readMatch(reader, *from.image);
  // A layer of several labels has the color of the first one that has a color.
  for (const int value : values) {
    const auto color = from.image->labels.colors.find(value);
    if (color == from.image->labels.colors.end()) continue;
    if (common->options.on_color) common->options.on_color(layer, color->second);
    break;
  }
  const double voxel_size = reader.value("voxel");
  std::string summary = values.size() == 1 ? "label" : "labels";
  for (const int value : values) summary += " " + std::to_string(value);
  summary += " of " + fileName(from.image->file->path());
  const std::size_t index = from.image->layers.size();
  from.image->layers.push_back(values);
  GridSource source = from.source(layer, std::move(summary));
  source.make = [image = from.image, index, voxel_size,
                 bake = from.bake](const Progress& progress) {
    return image->surfaces().surface(index, voxel_size, bake, progress, LabelEdge::kLapped);
  };
  source.measure = [image = from.image, values](const Progress&) {
    return image->file->boxOfLabels(values);
  };
  source.content = [image = from.image, index, voxel_size, bake = from.bake,
                    sampler = from.sampler](const Progress&) {
    GridContent content = LayerImage::content(*image->file, "labels");
    content.box = content.grid;
    content.box.add("box");
    for (const int value : image->layers[index]) content.box.add(value);
    // The border of a layer depends on its neighbors.
    for (const std::vector<int>& labels : image->layers) {
      content.grid.add(labels.size());
      for (const int value : labels) content.grid.add(value);
    }
    content.grid.add(index).add(voxel_size);
    addHow(content.grid, bake, sampler);
    return content;
  };
  return {lazyField(common, std::move(source)), from.name, values};
}

SceneRegistry::LayerSurface thresholdLayer(const CommonPtr& common, const MapReader& reader,
                                           const std::string& layer) {
  const LayerImage from(reader, layer, common->options.max_memory);
  ThresholdOptions threshold;
  const bool is_below = reader.has("below");
  if (is_below && reader.has("above")) {
    throw reader.errorAt("below", "scene.kind", "'threshold' has both 'above' and 'below'",
                         "give one: the inside is either above or below the value");
  }
  const char* key = is_below ? "below" : "above";
  if (!reader.has(key)) {
    throw reader.errorAt("", "scene.missing_key", "'threshold' has no 'above'", "add above: ...");
  }
  const Node& level = *reader.find(key);
  (is_below ? threshold.below.emplace() : threshold.above) = reader.value(key);
  threshold.largest_component = reader.choice("keep") == 0;
  threshold.fill = reader.flag("fill");
  threshold.voxel_size = reader.value("voxel");
  std::string summary = fileName(from.image->file->path()) + " " + key + " " + level.text;
  GridSource source = from.source(layer, std::move(summary));
  source.make = [common, file = from.image->file, threshold,
                 bake = from.bake](const Progress& progress) {
    const std::string note = threshold.below ? std::string() : distancesNote(file->image());
    if (!note.empty()) {
      common->notes->add(file->path(), {note + "; below: 0 (--distances) takes the inside"});
    }
    return surfaceFromThreshold(file->image(), threshold, bake, progress);
  };
  source.measure = [file = from.image->file, threshold](const Progress&) {
    return boxWhere(file->image(), [&](float value) {
      return threshold.below ? value < *threshold.below : value > threshold.above;
    });
  };
  source.content = [file = from.image->file, threshold, bake = from.bake,
                    sampler = from.sampler](const Progress&) {
    GridContent content = LayerImage::content(*file, "threshold");
    content.grid.add(threshold.below.has_value());
    content.grid.add(threshold.below.value_or(threshold.above));
    content.box = content.grid;
    content.box.add("box");
    content.grid.add(threshold.largest_component).add(threshold.fill).add(threshold.voxel_size);
    addHow(content.grid, bake, sampler);
    return content;
  };
  return {lazyField(common, std::move(source)), {}};
}

}  // namespace

void registerKinds(SceneRegistry& registry, const RegisterOptions& options) {
  registerKinds(registry, options, BundleOptions{});
}

void registerKinds(SceneRegistry& registry, const RegisterOptions& options,
                   const BundleOptions& bundle) {
  registry.vocabulary = vocabulary(*registry.vocabulary);
  auto notes = std::make_shared<Notes>(options.on_note);
  const auto common = std::make_shared<Common>(
      Common{options, bundle, notes, SceneImages(notes, options.on_image)});
  registry.image = [common](MapReader& reader) { return common->images.read(reader); };
  registry.fields["mesh"] = [common](MapReader& reader) { return meshField(common, reader); };
  registry.fields["grid"] = [common](MapReader& reader) { return gridFileField(common, reader); };
  registry.fields["mask"] = [common](MapReader& reader) { return maskField(common, reader); };
  registry.fields["baked"] = [common](MapReader& reader) {
    return readBaked(reader, common->options);
  };
  registry.choose_grids = [common](const FieldSourcePtr& field,
                                   const SceneRegistry::GridChoice& choice) {
    return chooseGrids(field, choice, common->options);
  };
  registry.maps["grid"] = [common](MapReader& reader, const ParameterKind& of) {
    return readGridMap(reader, of, common->options);
  };
  registry.maps["image"] = [common](MapReader& reader, const ParameterKind& of) {
    return readImageMap(reader, of, common->options);
  };
  registry.layers["labels"] = [common](MapReader& reader, const std::string& layer) {
    return labelsLayer(common, reader, layer);
  };
  registry.layers["threshold"] = [common](MapReader& reader, const std::string& layer) {
    return thresholdLayer(common, reader, layer);
  };
}

}  // namespace palpate::vdb
