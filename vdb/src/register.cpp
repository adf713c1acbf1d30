#include "palpate/vdb/register.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numbers>
#include <utility>

#include "bake/solid.h"
#include "named_progress.h"
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

using GridMaker = std::function<LevelSet(const Progress&)>;
/// Other ways than a grid alone.
struct MeshWays {
  std::function<FieldPtr(const Progress&)> instead =
      {};  ///< tried first; null where a grid is needed
  std::function<FieldPtr(FieldPtr, const LevelSet&)> finish = {};  ///< of the grid's whole field
};
using Measurer = FieldSource::Measurer;

/// What the makers need after the scene file is read and its readers are gone.
struct Common {
  RegisterOptions options;
  std::shared_ptr<Notes> notes;
  SceneImages images;
};
using CommonPtr = std::shared_ptr<Common>;

std::string widenedNote(double half_width) {
  return "a band of " + shortNumber(half_width, 3) +
         " voxels is too narrow for cubic sampling; it was widened to " +
         shortNumber(kCubicHalfWidth, 6) + ", with distances to the closest points of the surface";
}

/// A grid that comes out of this module's own hands.
CertifyOptions madeHere() {
  CertifyOptions options;
  options.is_foreign = false;
  return options;
}

/// The field of a grid that is made when it is first asked for. The maker reports what it finds wrong
/// at `place` of the scene; `what` names the grid in progress and records.
FieldSourcePtr lazyField(const CommonPtr& common, std::string what, std::string summary,
                         SourcePlace place, Sampler sampler, GridMaker make, Measurer measure,
                         MeshWays ways = {}, CertifyOptions origin = madeHere()) {
  auto measurer = [place, measure = std::move(measure)](const Progress& progress) {
    try {
      return measure(progress);
    } catch (const Error& error) {
      throwAt(place, error);
    }
  };
  auto maker = [common, what = std::move(what), summary, place = std::move(place), sampler,
                make = std::move(make), ways = std::move(ways),
                origin = std::move(origin)](const Box3& within, const Progress& progress) {
    const Progress named = namedProgress(progress, what);
    if (ways.instead) {
      try {
        if (FieldPtr exact = ways.instead(named)) return exact;
      } catch (const Error& error) {
        throwAt(place, error);
      }
    }
    const auto start = std::chrono::steady_clock::now();
    LevelSet grid;
    LevelSetInfo made;
    try {
      grid = make(named);
      made = grid.info();
      if (made.metadata.contains("lost_parts")) {
        common->notes->add(what, {"not in the grid: " + made.metadata.at("lost_parts")});
      }
      CertifyOptions certify = origin;
      certify.sampler = sampler;
      certify.cache_folder = common->options.cache_folder;
      certify.max_memory = common->options.max_memory;
      CertifiedGrid sure = certified(grid, certify, named);
      grid = std::move(sure.grid);
      if (sampler == Sampler::kCubic && isTooNarrow(made)) {
        common->notes->add(what, {widenedNote(made.half_width)});
      }
      if (!sure.notes.empty()) common->notes->add(what, sure.notes);
      const std::string rough = roughNote(grid, sure.certificate);
      if (!rough.empty()) common->notes->add(what, {rough});
    } catch (const Error& error) {
      throwAt(place, error);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (common->options.on_grid) {
      common->options.on_grid({what + ": " + summary, made, took.count()});
    }
    const std::uint64_t limit = common->options.max_memory;
    if (!ways.finish) return gridField(grid, sampler, within, limit);
    try {
      return ways.finish(gridField(grid, sampler, Box3::everything(), limit), grid);
    } catch (const Error& error) {
      throwAt(place, error);
    }
  };
  return std::make_shared<FieldSource>(std::move(summary), std::move(maker), std::move(measurer));
}

/// How a mesh becomes a solid.
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

/// Whether edges of a mesh of flat faces stay sharp: unless a grid is asked for.
bool readEdges(const MapReader& reader) {
  if (reader.has("edges")) return reader.choice("edges") == 0;
  constexpr const char* kOfGrids[] = {"voxel", "half_width", "sampler", "shell", "smooth"};
  return std::none_of(std::begin(kOfGrids), std::end(kOfGrids),
                      [&](const char* key) { return reader.has(key); });
}

/// [rad] The angle at `sharp`; 0 if it is not there.
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
  const double metres = *metresPer(reader.has("units")  ? reader.text("units")
                                   : prescribed.empty() ? bake.length_unit
                                                        : prescribed);
  bake.voxel_size = reader.value("voxel");
  bake.half_width = reader.value("half_width");
  readMeshKeys(reader, bake);
  const Space space = readSpace(reader);
  bake.metadata["source"] = path;
  const Sampler sampler = readSampler(reader);
  const auto read = [common, path, metres, space](const Progress& progress) {
    report(progress, "read", 0.0);
    Mesh mesh = readMesh(path, metres, space);
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
                   " sharp edges are rounded as in a grid, as parts overlap beside them, at " +
                   eachInMillimetres(made.place) + " for one; one solid would keep them sharp"});
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
  return lazyField(
      common, fileName(path), "mesh " + fileName(path),
      reader.loader().document().place(reader.node().mark), sampler,
      [read, bake](const Progress& progress) {
        const Mesh mesh = read(progress);
        BakeOptions options = bake;
        if (!(options.voxel_size > 0.0)) {
          const Vec3 size = checkMesh(mesh).bounds.size();
          options.voxel_size = std::max({size.x, size.y, size.z}) / 128.0;
        }
        return bakeMesh(mesh, options, progress);
      },
      [path, metres, space, shell = bake.shell_thickness](const Progress&) {
        return boxOf(readMesh(path, metres, space)).grownBy(shell);
      },
      std::move(ways));
}

FieldSourcePtr gridFileField(const CommonPtr& common, const MapReader& reader) {
  const std::string path = readExistingFile(reader, "file");
  const std::string name = reader.text("name");
  const std::string unit = reader.text("units");
  const auto unknown = reader.has("class") ? UnknownClass::kLevelSet : UnknownClass::kRefuse;
  const Sampler sampler = readSampler(reader);
  CertifyOptions foreign;
  foreign.path = path;
  return lazyField(
      common, fileName(path), "grid " + fileName(path),
      reader.loader().document().place(reader.node().mark), sampler,
      [path, name, unit, unknown, limit = common->options.max_memory](const Progress& progress) {
        report(progress, "read", 0.0);
        return readVdb(path, name, unit, unknown, limit);
      },
      [path, name, unit, unknown, limit = common->options.max_memory](const Progress&) {
        return readVdb(path, name, unit, unknown, limit).info().bounds;
      },
      {}, foreign);
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
  return lazyField(
      common, fileName(mask.file), "mask " + fileName(mask.file),
      reader.loader().document().place(reader.node().mark), sampler,
      [mask, bake](const Progress& progress) {
        report(progress, "read", 0.0);
        return surfaceOfMask(mask, bake, progress);
      },
      [mask](const Progress&) {
        return boxWhere(readVdbImage(mask.file, mask.name, mask.unit_if_missing),
                        [](float value) { return value != 0.0F; });
      });
}

/// The image a layer names, and what its grid will be called.
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
  // Several labels have the color of the first that has one.
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
  return {lazyField(
              common, layer, std::move(summary), from.place, from.sampler,
              [image = from.image, index, voxel_size, bake = from.bake](const Progress& progress) {
                return image->surfaces().surface(index, voxel_size, bake, progress,
                                                 LabelEdge::kLapped);
              },
              [image = from.image, values](const Progress&) {
                return image->file->boxOfLabels(values);
              }),
          from.name, values};
}

SceneRegistry::LayerSurface thresholdLayer(const CommonPtr& common, const MapReader& reader,
                                           const std::string& layer) {
  const LayerImage from(reader, layer, common->options.max_memory);
  ThresholdOptions threshold;
  const bool is_below = reader.has("below");
  if (is_below && reader.has("above")) {
    throw reader.errorAt("below", "scene.kind", "'threshold' has both 'above' and 'below'",
                         "a surface lies around what is greater, or around what is less");
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
  return {
      lazyField(
          common, layer, std::move(summary), from.place, from.sampler,
          [common, file = from.image->file, threshold, bake = from.bake](const Progress& progress) {
            const std::string note = threshold.below ? std::string() : distancesNote(file->image());
            if (!note.empty()) {
              common->notes->add(file->path(),
                                 {note + "; below: 0 (--distances) takes the inside"});
            }
            return surfaceFromThreshold(file->image(), threshold, bake, progress);
          },
          [file = from.image->file, threshold](const Progress&) {
            return boxWhere(file->image(), [&](float value) {
              return threshold.below ? value < *threshold.below : value > threshold.above;
            });
          }),
      {}};
}

}  // namespace

void registerKinds(SceneRegistry& registry, const RegisterOptions& options) {
  registry.vocabulary = vocabulary(*registry.vocabulary);
  auto notes = std::make_shared<Notes>(options.on_note);
  const auto common =
      std::make_shared<Common>(Common{options, notes, SceneImages(notes, options.on_image)});
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
