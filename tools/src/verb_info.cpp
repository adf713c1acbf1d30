#include <algorithm>
#include <cmath>

#include "image_report.h"
#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/mesh.h"
#include "scan_options.h"
#include "scene_parameters.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

std::string plural(std::size_t count, const std::string& thing) {
  return formatCount(count) + " " + thing + (count == 1 ? "" : "s");
}

FileReport sceneInfo(const std::string& file, Console& console) {
  const LoadedScene loaded(file, console);
  const SceneDescription& d = loaded.description();
  FileReport out;
  out.json = {{"file", file}, {"kind", "scene"}, {"length_unit", d.length_unit}};
  out.json["layers"] = Json::array();
  out.text = file + ": a scene, lengths in " + d.length_unit + "\n";
  const auto source_of = [](const FieldSource& field) {
    return field.summary().empty() ? std::string("formula") : field.summary();
  };
  Table layers({"layer", "made from", "wall", "content"});
  for (const auto& layer : d.layers) {
    const std::string source = source_of(*layer.inside);
    const std::string wall = layer.wall.absent             ? "absent"
                             : layer.wall.material.empty() ? "default"
                                                           : layer.wall.material;
    layers.add({layer.name, source, wall, layer.content.empty() ? "-" : layer.content});
    out.json["layers"].push_back(
        {{"name", layer.name},
         {"source", source},
         {"wall", wall},
         {"content", layer.content.empty() ? Json() : Json(layer.content)}});
  }
  if (!layers.empty()) out.text += layers.text("  ");
  out.json["sheets"] = Json::array();
  for (const auto& sheet : d.sheets) {
    const std::string wall = sheet.material.empty() ? "default" : sheet.material;
    out.text +=
        "  sheet " + sheet.name + " made from " + source_of(*sheet.on) + ", wall " + wall + "\n";
    out.json["sheets"].push_back(
        {{"name", sheet.name}, {"source", source_of(*sheet.on)}, {"wall", wall}});
  }
  out.json["ports"] = Json::array();
  for (const auto& port : d.ports) {
    out.text += "  port " + port.name + " between " + port.from + " and " + port.to + "\n";
    out.json["ports"].push_back(
        {{"name", port.name}, {"between", Json::array({port.from, port.to})}});
  }
  out.json["maps"] = Json::array();
  for (const SceneParameter& found : sceneParameters(d)) {
    const std::string values =
        formatParameter(found.map) + (found.unit == "1" ? "" : " " + found.unit);
    out.text += "  map " + found.name() + ": " + values + "\n";
    Json json = parameterJson(found.map);
    json["name"] = found.name();
    json["unit"] = found.unit;
    out.json["maps"].push_back(std::move(json));
  }
  out.json["images"] = Json::array();
  for (const auto& image : loaded.images()) {
    out.text += "  image " + image.name + ": " + image.file + "\n";
    out.json["images"].push_back({{"name", image.name}, {"file", image.file}});
  }
  out.text += "  the probe starts in " + d.start_region + "; palpate explain shows more\n";
  out.json["start"] = d.start_region;
  return out;
}

FileReport gridInfo(const std::string& file) {
  FileReport out;
  out.json = {{"file", file}, {"kind", "grids"}, {"grids", Json::array()}};
  const auto grids = vdb::listVdb(file);
  out.text = file + ": OpenVDB, " + plural(grids.size(), "grid") + "\n";
  for (const auto& grid : grids) {
    const auto& info = grid.info;
    const bool unit_known = !info.length_unit.empty();
    const double unit = unit_known ? info.meters_per_unit : 1.0;
    const std::string name = unit_known ? info.length_unit : "units (no length unit in the file)";
    out.text += "  " + (grid.name.empty() ? "(no name)" : grid.name) + ": " + grid.type + ", " +
                grid.grid_class + "\n    " + plural(info.active_voxels, "active voxel") + " of " +
                formatNumber(info.voxel_size / unit) + " " + name + ", " +
                formatBytes(info.memory) + "\n    bounds " +
                boxText(info.bounds, unit, unit_known ? info.length_unit : "units") + "\n";
    if (info.half_width > 0.0) {
      out.text += "    band " + formatNumber(info.half_width) + " voxels on each side";
      if (grid.grid_class == "level set" && vdb::isTooNarrow(info)) {
        out.text += "; cubic sampling widens it to " + formatNumber(vdb::kCubicHalfWidth);
      }
      out.text += "\n";
    }
    if (const auto value_unit = info.metadata.find("unit");
        grid.grid_class == "fog volume" && value_unit != info.metadata.end()) {
      out.text += "    a map for materials, in " + value_unit->second + "\n";
    }
    Json metadata = Json::object();
    for (const auto& [key, value] : info.metadata) {
      metadata[key] = value;
      out.text += "    " + key + ": " + value + "\n";
    }
    out.json["grids"].push_back({{"name", grid.name},
                                 {"type", grid.type},
                                 {"class", grid.grid_class},
                                 {"voxel_size_m", info.voxel_size},
                                 {"half_width_voxels", info.half_width},
                                 {"active_voxels", info.active_voxels},
                                 {"memory_bytes", info.memory},
                                 {"bounds_m", boxJson(info.bounds)},
                                 {"length_unit", unit_known ? Json(info.length_unit) : Json()},
                                 {"metadata", metadata}});
  }
  return out;
}

FileReport meshInfo(const std::string& file, const InfoOptions& options, Console& console) {
  const LengthUnit unit = meshUnit(options.units);
  const vdb::Mesh mesh = readMeshFile(file, options.units, options.scan, console);
  const vdb::MeshReport r = vdb::checkMesh(mesh);
  FileReport out;
  out.json = {{"file", file},
              {"kind", "mesh"},
              {"length_unit", unit.name},
              {"space", mesh.space == vdb::Space::kLps ? "LPS" : "RAS"},
              {"space_stated", mesh.space_is_stated},
              {"vertices", mesh.vertices.size()},
              {"triangles", mesh.triangles.size()},
              {"components", r.components},
              {"closed", r.isClosed()},
              {"boundary_edges", r.boundary_edges},
              {"non_manifold_edges", r.non_manifold_edges},
              {"flipped_edges", r.flipped_edges},
              {"degenerate_triangles", r.degenerate_triangles},
              {"volume_m3", r.volume},
              {"bounds_m", boxJson(r.bounds)}};
  out.text = file + ": a " + (r.isClosed() ? "closed" : "open") + " mesh of " +
             plural(mesh.triangles.size(), "triangle") + " and " +
             formatCount(mesh.vertices.size()) + " vertices in " + plural(r.components, "piece") +
             "\n";
  out.text += "  space   " + spaceText(mesh, options.scan) + "\n";
  out.text += "  bounds  " + boxText(r.bounds, unit.meters, unit.name) + " (RAS)\n";
  out.text += "  volume  " + formatNumber(r.volume / std::pow(unit.meters, 3)) + " " + unit.name +
              "^3" + (r.volume < 0.0 ? " (the triangles wind inwards)" : "") + "\n";
  if (!r.isClosed()) {
    out.json["first_boundary_m"] = vectorJson(r.first_boundary);
    out.text += "  open at " + plural(r.boundary_edges, "edge") + ", one of them at " +
                formatVector(r.first_boundary / unit.meters) + " " + unit.name + "\n";
  }
  if (r.non_manifold_edges > 0) {
    out.text += "  " + plural(r.non_manifold_edges, "edge") + " with three triangles or more\n";
  }
  if (r.flipped_edges > 0) {
    out.text +=
        "  " + plural(r.flipped_edges, "edge") + " whose triangles disagree about the outside\n";
  }
  if (r.degenerate_triangles > 0) {
    out.text += "  " + plural(r.degenerate_triangles, "triangle") + " without area\n";
  }
  return out;
}

}  // namespace

Report run(const InfoOptions& options, const GeneralOptions&, Console& console) {
  Report report;
  report.json = {{"schema", "palpate.info/1"}, {"files", Json::array()}};
  for (const std::string& file : options.files) {
    checkStop();
    FileReport one;
    switch (inputKind(file)) {
      case InputKind::kScene:
        one = sceneInfo(file, console);
        break;
      case InputKind::kGrid:
        one = gridInfo(file);
        break;
      case InputKind::kMesh:
        one = meshInfo(file, options, console);
        break;
      case InputKind::kImage:
        one = imageReport(file, options, console);
        break;
    }
    if (!report.text.empty()) report.text += "\n";
    report.text += one.text;
    report.json["files"].push_back(std::move(one.json));
  }
  return report;
}

}  // namespace palpate::tools
