#include "scene_baked.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "named_progress.h"
#include "palpate/core/error.h"
#include "palpate/scene/vocabulary.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_memory.h"
#include "scene_grid.h"

namespace palpate::vdb {
namespace {

constexpr double kVoxelsAlong = 128.0;

HybridOptions readOptions(const MapReader& reader) {
  constexpr Parts kParts[] = {Parts::kAuto, Parts::kOperands, Parts::kWhole};
  HybridOptions options;
  options.bake.length_unit = reader.loader().lengthUnit();
  options.bake.name = reader.text("name");
  options.bake.voxel_size = reader.value("voxel");
  options.bake.half_width = reader.value("half_width");
  options.tolerance = reader.value("tolerance");
  options.parts = kParts[reader.choice("parts")];
  options.sampler = readSampler(reader);
  if (options.parts == Parts::kWhole && options.tolerance > 0.0) {
    throw reader.errorAt(
        "tolerance", "scene.range",
        "'tolerance' has no effect with parts: whole, which makes one grid, whatever "
        "its error",
        "leave out tolerance, or write parts: auto or parts: operands");
  }
  return options;
}

double longestSide(const Field& field) {
  const Box3 bounds = field.bounds();
  if (!bounds.isBounded()) {
    throw inputError("bake.unbounded", "the field reaches to infinity, and no voxel size was given",
                     "give `voxel`, and bake what this field is cut to, not the field alone");
  }
  const Vec3 size = bounds.size();
  return std::max({size.x, size.y, size.z});
}

/// Reports each part's grid, and each decision about a part.
void tell(const RegisterOptions& options, const std::string& what, const Hybrid& made,
          double seconds) {
  bool is_first = true;
  for (const HybridPart& part : made.parts) {
    const std::string name = part.name.empty() ? what : what + ", part " + part.name;
    if (options.on_note) options.on_note(name + " " + part.reason);
    if (!part.grid || !options.on_grid) continue;
    // The time is for all grids together, and reported once.
    options.on_grid({name, part.grid.info(), is_first ? seconds : 0.0});
    is_first = false;
  }
}

/// The file that holds the grids; empty: grids are made.
std::string readFile(const MapReader& reader) {
  if (!reader.has("file")) return {};
  for (const std::string& key : reader.words("file").excludes) {
    if (!reader.has(key)) continue;
    throw reader.errorAt(
        key, "scene.range",
        "'" + key + "' applies to grids that are made here; those of a file cannot be changed",
        "leave out " + key + ", or leave out file");
  }
  return readExistingFile(reader, "file");
}

/// `field` with its parts replaced by the grids of the file at `path`. The grid of part 2.1 is
/// called NAME/2.1, where NAME is the one in `asked`.
FieldPtr withSaved(const FieldPtr& field, const std::string& path, const HybridOptions& asked,
                   const std::string& what, const RegisterOptions& options) {
  const std::string& name = asked.bake.name;
  std::map<std::string, LevelSet> grids;
  for (const VdbGridSummary& summary : listVdb(path)) {
    const bool is_whole = summary.name == name;
    if (!is_whole && !summary.name.starts_with(name + "/")) continue;
    // Repairs are reported, as for a grid that a scene names.
    CertifyOptions certify;
    certify.sampler = asked.sampler;
    certify.path = path;
    certify.cache_folder = options.cache_folder;
    certify.max_memory = options.max_memory;
    CertifiedGrid sure = certified(
        readVdb(path, summary.name, "", UnknownClass::kRefuse, options.max_memory), certify);
    for (const std::string& note : sure.notes) {
      if (options.on_note) options.on_note(what + ": " + note);
    }
    grids[is_whole ? "" : summary.name.substr(name.size() + 1)] = std::move(sure.grid);
  }
  if (grids.empty()) {
    throw inputError("bake.no_parts", "no grid in it is called " + name + " or " + name + "/PART",
                     "palpate info lists its grids", path);
  }
  FieldPtr out = recombined(field, grids, asked.sampler, asked.within, options.max_memory);
  for (const auto& [part, grid] : grids) {
    if (!options.on_grid) break;
    options.on_grid({part.empty() ? what : what + ", part " + part, grid.info(), 0.0});
  }
  return out;
}

}  // namespace

FieldSourcePtr readBaked(const MapReader& reader, const RegisterOptions& options) {
  const FieldSourcePtr field = reader.loader().field(*reader.find("field"));
  HybridOptions asked = readOptions(reader);
  asked.bake.max_memory = options.max_memory;
  const std::string file = readFile(reader);
  const SourcePlace place = reader.loader().document().place(reader.node().mark);
  const std::string what = "baked field in line " + std::to_string(place.line);
  auto make = [field, file, asked, place, what, options](const Box3& within,
                                                         const Progress& progress) {
    const FieldPtr operand = field->get(progress);
    const auto start = std::chrono::steady_clock::now();
    HybridOptions hybrid = asked;
    hybrid.within = within;
    Hybrid made;
    try {
      if (!file.empty()) return withSaved(operand, file, hybrid, what, options);
      if (!(hybrid.bake.voxel_size > 0.0)) {
        hybrid.bake.voxel_size = longestSide(*operand) / kVoxelsAlong;
      }
      made = bakeHybrid(operand, hybrid, namedProgress(progress, what));
    } catch (const Error& error) {
      throwAt(place, error);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    tell(options, what, made, took.count());
    return made.field;
  };
  const std::string& from = field->summary();
  return std::make_shared<FieldSource>(
      "baked" + (from.empty() ? "" : " " + from), std::move(make),
      [field](const Progress& progress) {
        return field->bounds(progress).value_or(Box3::everything());
      });
}

FieldSourcePtr chooseGrids(const FieldSourcePtr& field, const SceneRegistry::GridChoice& choice,
                           const RegisterOptions& options) {
  const std::string what = "layer " + choice.layer;
  HybridOptions hybrid;
  hybrid.bake.length_unit = choice.length_unit;
  hybrid.bake.name = choice.layer + "/surface";
  hybrid.bake.metadata["layer"] = choice.layer;
  hybrid.bake.max_memory = options.max_memory;
  hybrid.bake.voxel_size = choice.voxel_size;
  hybrid.tolerance = choice.tolerance;
  hybrid.keep = choice.keep;
  auto make = [field, hybrid, what, place = choice.place, options](const Box3& within,
                                                                   const Progress& progress) {
    const FieldPtr operand = field->get(progress);
    if (!operand->bounds().isBounded()) {
      if (options.on_note) options.on_note(what + " stays a formula: it has no end");
      return operand;
    }
    HybridOptions asked = hybrid;
    asked.within = within;
    if (!(asked.bake.voxel_size > 0.0))
      asked.bake.voxel_size = longestSide(*operand) / kVoxelsAlong;
    const auto start = std::chrono::steady_clock::now();
    Hybrid made;
    try {
      made = bakeHybrid(operand, asked, namedProgress(progress, what));
    } catch (const Error& error) {
      throwAt(place, error);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    tell(options, what, made, took.count());
    return made.field;
  };
  return std::make_shared<FieldSource>(
      "formula, or grids where faster", std::move(make), [field](const Progress& progress) {
        return field->bounds(progress).value_or(Box3::everything());
      });
}

}  // namespace palpate::vdb
