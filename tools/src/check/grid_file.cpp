#include <algorithm>
#include <cmath>

#include "check/file_check.h"
#include "json_parts.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/grid_check.h"
#include "vdb_grid_name.h"

namespace palpate::tools {
namespace {

/// If the mean of |gradient| differs from 1 by more than this, values are not distances in the
/// grid's own unit: forces and contact would be wrong by as much. The same limit as in certified().
constexpr double kMostSlope = 0.25;

struct GridVerdict {
  bool is_yes = true;
  bool is_surface = true;  ///< it is, or might be, a surface that can be touched
  std::vector<Finding> findings;
};

void findVoxels(const vdb::GridCheck& check, const LengthUnit& unit, GridVerdict& verdict) {
  const auto add = [&](const char* code, const vdb::VoxelDefect& defect, const std::string& what) {
    if (defect.voxels == 0) return;
    verdict.findings.push_back({code,
                                countOf(defect.voxels, "voxel", "voxels") + " " + what +
                                    ", one at " + placeText(defect.place, unit),
                                defect.voxels, defect.place});
  };
  add("grid.not_finite", check.not_finite, "with values that are not finite numbers");
  add("grid.sign_break", check.sign_breaks,
      "where inside and outside meet without a band in between: the inside is not marked as such "
      "(palpate convert FILE.vdb -o OTHER.vdb marks it), or the grid was cut off");
  add("grid.band_hole", check.band_holes, "at a hole in the band");
}

GridVerdict judge(const vdb::GridCheck& check, const LengthUnit& unit) {
  GridVerdict verdict;
  verdict.is_surface = check.has_distances || check.grid.grid_class == "level set";
  // The same function decides here and for grids that a scene names.
  verdict.is_yes = !check.refused && !check.uncertified;
  if (!check.has_distances) return verdict;
  const vdb::GradientStatistics& g = check.gradient;
  if (g.voxels > 0 && !(std::abs(g.mean - 1.0) <= kMostSlope)) {
    verdict.findings.push_back(
        {"grid.gradient",
         "|gradient| is " + formatNumber(g.mean, 3) +
             " on average, so that its values are not distances in its own unit (" +
             (g.mean > 1.0 ? "voxels or another unit, or densities"
                           : "another unit, or densities") +
             ")",
         0});
  }
  if (check.grid.info.active_voxels > 0 && check.inside_voxels == 0) {
    verdict.findings.push_back({"grid.no_inside", "no voxel of the band is inside (negative)", 0});
  }
  findVoxels(check, unit, verdict);
  return verdict;
}

Json certificateJson(const vdb::BandCertificate& c) {
  return {{"within_m", c.within},
          {"lipschitz", c.lipschitz},
          {"steepest", c.steepest},
          {"slope", c.slope},
          {"slope_place_m", vectorJson(c.slope_place)},
          {"rough_share", c.rough},
          {"off_m", c.off},
          {"content", c.content}};
}

std::string certificateText(const vdb::BandCertificate& c, const LengthUnit& unit) {
  std::string text = "    certified: values and normals within " +
                     formatNumber(c.within / unit.meters, 3) + " " + unit.name +
                     " of the surface; no slope above " + formatNumber(c.steepest, 3) +
                     "; surface off by at most " + formatNumber(c.off / unit.meters, 2) + " " +
                     unit.name + " where it is smooth\n";
  if (c.rough > 0.0) {
    text += "    " + formatNumber(100.0 * c.rough, 2) +
            " % of the surface has edges, or bends within a voxel, one at " +
            placeText(c.slope_place, unit) + "\n";
  }
  return text;
}

Json gridJson(const vdb::GridCheck& check, const GridVerdict& verdict) {
  const vdb::LevelSetInfo& info = check.grid.info;
  Json json = {
      {"name", check.grid.name},
      {"ok", verdict.is_yes},
      {"type", check.grid.type},
      {"class", check.grid.grid_class},
      {"length_unit", info.length_unit.empty() ? Json() : Json(info.length_unit)},
      {"frame", info.metadata.contains("frame") ? Json(info.metadata.at("frame")) : Json()},
      {"voxel_size_m", info.voxel_size},
      {"half_width_voxels", info.half_width},
      {"active_voxels", info.active_voxels},
      {"refused", check.refused ? problemJson(*check.refused) : Json()},
      {"widened", !check.refused && vdb::isTooNarrow(info)},
      {"uncertified", check.uncertified ? problemJson(*check.uncertified) : Json()},
      {"certificate", check.certificate ? certificateJson(*check.certificate) : Json()},
      {"repairs", check.repairs},
      {"findings", findingsJson(verdict.findings)}};
  if (!check.has_distances) return json;
  const vdb::GradientStatistics& g = check.gradient;
  json["inside_voxels"] = check.inside_voxels;
  json["volume_m3"] = check.volume;
  json["gradient"] = {{"voxels", g.voxels},
                      {"mean", g.mean},
                      {"rms_deviation_of_1", g.deviation},
                      {"worst", g.worst},
                      {"worst_place_m", vectorJson(g.worst_place)}};
  return json;
}

std::string gridText(const vdb::GridCheck& check, const GridVerdict& verdict,
                     const LengthUnit& unit) {
  const vdb::LevelSetInfo& info = check.grid.info;
  std::string text = "  " + (check.grid.name.empty() ? "(no name)" : check.grid.name) + ": " +
                     check.grid.type + ", " + check.grid.grid_class + ", " +
                     countOf(info.active_voxels, "active voxel", "active voxels") + " of " +
                     formatNumber(info.voxel_size / unit.meters) + " " + unit.name + "\n";
  if (check.has_distances) {
    const vdb::GradientStatistics& g = check.gradient;
    text += "    band     " + formatNumber(info.half_width) + " voxels on each side\n";
    if (g.voxels > 0) {
      text += "    gradient " + formatNumber(g.mean) + " on average, " +
              formatNumber(g.deviation, 2) + " RMS from 1, at worst " + formatNumber(g.worst, 3) +
              " at " + formatVector(g.worst_place / unit.meters) + " " + unit.name + "\n";
    }
    text += "    volume   " + formatNumber(check.volume / std::pow(unit.meters, 3)) + " " +
            unit.name + "^3\n";
  }
  text += findingsText(verdict.findings, "    ");
  if (check.refused) return text + "    no: " + problemText(*check.refused) + "\n";
  if (check.uncertified) {
    return text + "    no: it is read, but cannot be touched as it is: " +
           problemText(*check.uncertified) + "\n";
  }
  if (check.certificate) text += certificateText(*check.certificate, unit);
  for (const std::string& repair : check.repairs) text += "    repaired  " + repair + "\n";
  return text + "    yes" +
         (vdb::isTooNarrow(info) ? ": cubic sampling widens its band to " +
                                       formatNumber(vdb::kCubicHalfWidth) + " voxels"
                                 : "") +
         "\n";
}

}  // namespace

FileCheck checkGridFile(const std::string& file, const CheckOptions& options, Console& console) {
  const auto unknown =
      options.level_set ? vdb::UnknownClass::kLevelSet : vdb::UnknownClass::kRefuse;
  if (!options.units.empty()) static_cast<void>(lengthUnit(options.units));
  const auto checks = vdb::checkVdb(file, gridName(file, options.layer), options.units, unknown,
                                    console.progress());
  FileCheck out;
  Json grids = Json::array();
  bool any_yes = false;
  bool any_no = false;
  std::string text;
  for (const vdb::GridCheck& check : checks) {
    const std::string& own = check.grid.info.length_unit;
    const std::string& name = own.empty() ? options.units : own;
    // Without a unit, places are given in the grid's own numbers, which are read as m.
    const LengthUnit unit = metersPer(name) ? lengthUnit(name) : LengthUnit{"units", 1.0};
    const GridVerdict verdict = judge(check, unit);
    any_yes = any_yes || verdict.is_yes;
    any_no = any_no || (!verdict.is_yes && verdict.is_surface);
    grids.push_back(gridJson(check, verdict));
    text += gridText(check, verdict, unit);
  }
  out.is_yes = any_yes && !any_no;
  out.json = {{"file", file}, {"kind", "grids"}, {"ok", out.is_yes}, {"grids", std::move(grids)}};
  out.text = file + ": OpenVDB, " + countOf(checks.size(), "grid", "grids") + "\n" + text;
  return out;
}

}  // namespace palpate::tools
