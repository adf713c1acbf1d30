#include <cstdint>
#include <numbers>
#include <utility>

#include "baking.h"
#include "input_kind.h"
#include "json_parts.h"
#include "output_files.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_error.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/text.h"
#include "part_baking.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
/// Larger grids do not get bricks only to measure their errors: bricks take several hundred MB.
constexpr std::uint64_t kMostForBricks = 10'000'000;  // active voxels

/// The grids as a table and as JSON.
class GridList {
 public:
  /// Returns the added grid's JSON, so that the caller can add to it.
  Json& add(const vdb::LevelSet& grid, double seconds) {
    const vdb::LevelSetInfo& info = grid.info();
    const double unit = info.meters_per_unit;
    table_.add({info.name, formatNumber(info.voxel_size / unit, 3) + " " + info.length_unit,
                formatCount(info.active_voxels), formatBytes(info.memory), formatSeconds(seconds),
                formatVector(info.bounds.lo / unit) + " to " + formatVector(info.bounds.hi / unit) +
                    " " + info.length_unit});
    json_.push_back({{"name", info.name},
                     {"voxel_size_m", info.voxel_size},
                     {"half_width_voxels", info.half_width},
                     {"active_voxels", info.active_voxels},
                     {"memory_bytes", info.memory},
                     {"bounds_m", boxJson(info.bounds)},
                     {"seconds", seconds}});
    const auto lost = info.metadata.find("lost_parts");
    json_.back()["lost_parts"] = lost == info.metadata.end() ? Json() : Json(lost->second);
    grids_.push_back(grid);
    return json_.back();
  }

  void add(const vdb::NamedMaterialGrid& material) {
    const vdb::MaterialGridInfo& info = material.grid->info();
    const double unit = lengthUnit(material.length_unit).meters;
    const auto voxels = static_cast<std::uint64_t>(info.size[0]) *
                        static_cast<std::uint64_t>(info.size[1]) *
                        static_cast<std::uint64_t>(info.size[2]);
    table_.add({material.name, formatNumber(info.voxel_size / unit, 3) + " " + material.length_unit,
                formatCount(voxels), formatBytes(info.memory), "-",
                formatVector(info.bounds.lo / unit) + " to " + formatVector(info.bounds.hi / unit) +
                    " " + material.length_unit});
    Json json = mapJson(*material.grid);
    json["name"] = material.name;
    json["unit"] = material.unit;
    materials_.push_back(std::move(json));
  }

  [[nodiscard]] const std::vector<vdb::LevelSet>& grids() const noexcept { return grids_; }
  [[nodiscard]] Report report(const BakeOptions& options, const std::string& written) const {
    Report report;
    report.json = {{"schema", "palpate.bake/1"},
                   {"input", options.input},
                   {"output", options.output},
                   {"grids", json_},
                   {"material_grids", materials_}};
    report.text = table_.text("") + "\nWrote " + written + "\n";
    return report;
  }

 private:
  Table table_{{"grid", "voxel", "active voxels", "memory", "made in", "bounds"}};
  Json json_ = Json::array();
  Json materials_ = Json::array();
  std::vector<vdb::LevelSet> grids_;
};

/// Reports the error of an analytic layer's grid, as the default sampler feels it if possible.
void tellError(const BakedGrid& baked, Json& json, Console& console) {
  if (!baked.analytic) return;
  const vdb::LevelSetInfo& info = baked.grid.info();
  // The spline would need a band that is too narrow to be widened first; the accessor shows the
  // same errors between voxels.
  const bool is_cubic = !vdb::isTooNarrow(info) && info.active_voxels <= kMostForBricks;
  const vdb::Sampler sampler = is_cubic ? vdb::Sampler::kCubic : vdb::Sampler::kAccessor;
  const FieldPtr made = vdb::gridField(baked.grid, sampler);
  const vdb::GridError error = vdb::gridError(*baked.analytic, baked.grid, *made);
  const vdb::GridError usual = vdb::smoothGridError(sampler, info.voxel_size);
  const bool holds_shape = error.turn <= usual.turn && error.off <= usual.off;
  json["error"] = {{"sampler", is_cubic ? "cubic" : "accessor"},
                   {"off_m", error.off},
                   {"turn_degrees", error.turn / kDegree},
                   {"where_m", {error.where.x, error.where.y, error.where.z}},
                   {"holds_shape", holds_shape}};
  if (holds_shape) return;
  const double unit = info.meters_per_unit;
  console.note(info.name + " cannot hold the shape everywhere: it is off by up to " +
               formatNumber(error.off / unit, 2) + " " + info.length_unit + " and " +
               formatNumber(error.turn / kDegree, 2) + " degrees, worst near " +
               formatVector(error.where / unit, 3) + " " + info.length_unit +
               " (an edge, a thin part or a tight bend); --parts FILE.yaml keeps such parts exact");
}

/// Certifies a grid that was made here, so that its file holds what contact may rely on. Grids
/// converted from another file, bands too narrow to be read as they are, and unsigned distances are
/// checked only when they are touched.
vdb::LevelSet sure(const vdb::LevelSet& grid, const BakeOptions& options, Console& console) {
  const bool is_whole =
      !vdb::isTooNarrow(grid.info()) && !grid.info().metadata.contains(vdb::kDistanceKey);
  if (!is_whole || inputKind(options.input) == InputKind::kGrid) return grid;
  vdb::CertifyOptions certify;
  certify.is_foreign = false;
  certify.path = options.output;
  vdb::CertifiedGrid made = vdb::certified(grid, certify);
  const std::string rough = vdb::roughNote(made.grid, made.certificate);
  if (!rough.empty()) console.note(grid.info().name + ": " + rough);
  return std::move(made.grid);
}

Json partJson(const std::string& layer, const vdb::HybridPart& part) {
  Json json = {{"layer", layer}, {"part", part.name}, {"reason", part.reason}};
  json["grid"] = part.grid ? Json(part.grid.info().name) : Json();
  json["off_m"] = part.grid ? Json(part.off) : Json();
  json["turn_degrees"] = part.grid ? Json(part.turn) : Json();
  return json;
}

}  // namespace

Report run(const BakeOptions& options, const GeneralOptions& general, Console& console) {
  if (!vdb::hasExtension(options.output, ".vdb")) {
    throw Error(ErrorKind::kUsage,
                {"usage.bake", "the output " + options.output + " must end in .vdb",
                 "palpate convert writes meshes and images"});
  }
  OutputFiles files(general);
  files.announce(options.output, {options.input, options.names});
  if (!options.parts.empty()) files.announce(options.parts, {options.input, options.names});

  GridList list;
  Json parts = Json::array();
  std::string written = options.output;
  std::vector<vdb::NamedMaterialGrid> materials;
  if (options.parts.empty()) {
    for (const BakedGrid& baked : bakeInput(options, console, &materials)) {
      tellError(baked, list.add(sure(baked.grid, options, console), baked.seconds), console);
    }
    for (const vdb::NamedMaterialGrid& material : materials) list.add(material);
  } else {
    const BakedParts baked = bakeParts(options, console);
    for (const LayerParts& layer : baked.layers) {
      for (const vdb::HybridPart& part : layer.parts) {
        parts.push_back(partJson(layer.layer, part));
        // The time is for all parts of the layer together.
        if (part.grid) (void)list.add(part.grid, layer.seconds);
      }
    }
    files.write(options.parts, baked.scene);
    written += " and " + options.parts;
  }
  checkStop();
  vdb::writeVdb(files.temporary(options.output), list.grids(), true, materials);
  checkStop();
  files.commit();

  Report report = list.report(options, written);
  if (!options.parts.empty()) {
    report.json["scene"] = options.parts;
    report.json["parts"] = parts;
  }
  return report;
}

}  // namespace palpate::tools
