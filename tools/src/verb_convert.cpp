#include <algorithm>

#include "baking.h"
#include "grid_baking.h"
#include "input_kind.h"
#include "json_parts.h"
#include "output_files.h"
#include "palpate/core/text.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/text.h"
#include "scan_options.h"
#include "slicer_markups.h"
#include "text.h"
#include "trace_reader.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.convert", std::move(message), std::move(hint)});
}

bool isImageName(const std::string& path) {
  return vdb::hasExtension(path, ".nii") || vdb::hasExtension(path, ".nii.gz");
}

/// Whether the input is a grid of distances, and no option changes it.
bool isTakenAsItIs(const BakeOptions& bake) {
  return inputKind(bake.input) == InputKind::kGrid && !bake.above && !bake.distances &&
         bake.labels.empty() && bake.voxel.empty();
}

/// The input's level set; null if its voxels are not cubes along the axes, or are not floats.
vdb::LevelSet takenAsItIs(const BakeOptions& bake, Console& console) {
  try {
    return readLevelSet(bake, console).grid;
  } catch (const Error& error) {
    if (!isMendable(error, bake)) throw;
    return {};
  }
}

/// The only grid, from which a mesh or image file is made.
vdb::LevelSet onlyGrid(const ConvertOptions& options, Console& console) {
  const BakeOptions& bake = options.bake;
  if (isTakenAsItIs(bake)) {
    if (vdb::LevelSet grid = takenAsItIs(bake, console)) return grid;
  }
  std::vector<BakedGrid> baked = bakeInput(bake, console);
  std::erase_if(baked, [](const BakedGrid& one) { return one.grid.info().name == kUnitedGrid; });
  if (baked.size() == 1) return baked.front().grid;
  const std::string names =
      joined(baked, ", ", [](const BakedGrid& one) { return one.grid.info().name; });
  throw usageError(bake.input + " gives " + std::to_string(baked.size()) + " surfaces: " + names,
                   "choose one with --layer or --labels; `palpate bake` writes all to one .vdb");
}

/// The unit of the mesh to write: the requested one, else that of the input's own numbers.
std::string unitOf(const ConvertOptions& options, const vdb::LevelSet& grid) {
  if (!options.to_units.empty()) return options.to_units;
  return grid ? grid.info().length_unit : options.bake.units.empty() ? "mm" : options.bake.units;
}

struct Written {
  std::string bytes;
  Json json;
  std::string text;
};

Written asMesh(const ConvertOptions& options, Console& console) {
  const vdb::MeshFormat format = vdb::meshFormat(options.bake.output);
  vdb::LevelSet grid;
  vdb::Mesh mesh;
  if (inputKind(options.bake.input) == InputKind::kMesh) {
    mesh = readMeshFile(options.bake.input, options.bake.units, options.bake.scan, console);
  } else {
    grid = onlyGrid(options, console);
    mesh = vdb::surfaceMesh(grid, console.progress());
  }
  const bool meters = format == vdb::MeshFormat::kGlb;
  if (meters && !options.to_units.empty() && options.to_units != "m") {
    throw usageError("a .glb file is always in meters", "leave --to-units out");
  }
  const LengthUnit unit = lengthUnit(meters ? "m" : unitOf(options, grid));
  const vdb::MeshReport report = vdb::checkMesh(mesh);
  Written out;
  out.bytes = vdb::encodeMesh(mesh, format, unit.meters);
  out.json = {{"kind", "mesh"},
              {"unit", unit.name},
              {"vertices", mesh.vertices.size()},
              {"triangles", mesh.triangles.size()},
              {"closed", report.isClosed()},
              {"volume_m3", report.volume},
              {"bounds_m", boxJson(report.bounds)}};
  out.text = formatCount(mesh.triangles.size()) + " triangles, one unit is 1 " + unit.name +
             (report.isClosed() ? "" : ", not closed") + "\n";
  return out;
}

Written asImage(const ConvertOptions& options, Console& console) {
  vdb::Image image;
  double meters = 1.0;
  const bool as_it_is = isTakenAsItIs(options.bake);
  vdb::LevelSet grid = as_it_is ? takenAsItIs(options.bake, console) : onlyGrid(options, console);
  if (!grid) {
    // A rotated or stretched grid becomes an image with the same placement and voxels.
    image = readDistances(options.bake, console);
    meters = lengthUnit(unitOfGrid(options.bake)).meters;
  } else {
    image = vdb::gridImage(grid);
    meters = grid.info().meters_per_unit;
  }
  constexpr double kMillimeter = 1e-3;  // the unit of a NIfTI file
  for (float& value : image.values) value *= static_cast<float>(meters / kMillimeter);
  Vec3 spacing(0.0);
  for (int axis = 0; axis < 3; ++axis) spacing[axis] = glm::length(image.axes[axis]);
  Written out;
  out.bytes = vdb::encodeNifti(image, vdb::hasExtension(options.bake.output, ".gz"));
  out.json = {{"kind", "image"},
              {"size", image.size},
              {"voxel_size_m", std::min({spacing.x, spacing.y, spacing.z})},
              {"spacing_m", vectorJson(spacing)},
              {"values", "signed distance, mm"}};
  out.text = std::to_string(image.size[0]) + " x " + std::to_string(image.size[1]) + " x " +
             std::to_string(image.size[2]) + " voxels with signed distances in mm\n";
  return out;
}

/// The path of the proxy of a trace, as a curve that Slicer loads.
Written asCurve(const ConvertOptions& options) {
  constexpr double kTolerance = 5e-5;  // [m] a tenth of what a scan resolves
  const std::string& input = options.bake.input;
  if (!vdb::hasExtension(input, ".csv")) {
    throw usageError("only a trace becomes a curve of Slicer's, not " + input,
                     "give what `palpate touch --trace FILE.csv` wrote");
  }
  TraceReader reader(input);
  std::vector<Vec3> path;
  std::size_t rows = 0;
  for (TraceLine line; reader.next(line); ++rows) {
    if (line.is_finite) path.push_back(line.proxy);
  }
  if (path.empty()) throw inputError("trace.empty", "the trace holds no place", {}, input);
  Markup curve{"Curve", stemOf(input), {}};
  for (const Vec3& point : thinned(path, kTolerance)) curve.points.push_back({"", point});
  Written out;
  out.bytes = markupsText({curve});
  out.json = {{"kind", "curve"},
              {"ticks", rows},
              {"points", curve.points.size()},
              {"tolerance_m", kTolerance}};
  out.text = "a curve of " + formatCount(curve.points.size()) + " points, within 0.05 mm of the " +
             "path of " + formatCount(rows) + " ticks\n";
  return out;
}

}  // namespace

Report run(const ConvertOptions& options, const GeneralOptions& general, Console& console) {
  const std::string& output = options.bake.output;
  const bool to_curve = isMarkupsName(output);
  const bool to_grid = vdb::hasExtension(output, ".vdb");
  const bool to_image = isImageName(output);
  if (!options.to_units.empty() && (to_grid || to_image || to_curve)) {
    throw usageError("--to-units applies to meshes", "a grid's unit is that of its input");
  }
  if (to_image && inputKind(options.bake.input) == InputKind::kImage && !options.bake.above &&
      options.bake.labels.empty() && !options.bake.distances) {
    throw usageError(
        "an image of distances needs a surface: --above VALUE, --labels NAME or --distances");
  }
  if (to_grid) return run(options.bake, general, console);

  OutputFiles files(general);
  files.announce(output, {options.bake.input, options.bake.names});
  const Written written = to_curve   ? asCurve(options)
                          : to_image ? asImage(options, console)
                                     : asMesh(options, console);
  checkStop();
  files.write(output, written.bytes);
  files.commit();
  Report report;
  report.json = {
      {"schema", "palpate.convert/1"}, {"input", options.bake.input}, {"output", output}};
  report.json.update(written.json);
  report.text = written.text + "Wrote " + output + "\n";
  return report;
}

}  // namespace palpate::tools
