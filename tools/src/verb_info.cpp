#include <algorithm>
#include <cmath>

#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/mesh.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

/// One file's part of the report.
struct FileReport {
  Json json;
  std::string text;
};

std::string boxText(const Box3& box, double unit, const std::string& name) {
  if (box.isEmpty()) return "empty";
  return formatVector(box.lo / unit) + " to " + formatVector(box.hi / unit) + " " + name;
}

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
    const double unit = unit_known ? info.metres_per_unit : 1.0;
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

FileReport meshInfo(const std::string& file, const std::string& units, Console& console) {
  if (units.empty()) console.note(file + ": one unit is taken as 1 mm; --units says otherwise");
  const LengthUnit unit = lengthUnit(units.empty() ? "mm" : units);
  const vdb::Mesh mesh = vdb::readMesh(file, unit.metres);
  const vdb::MeshReport r = vdb::checkMesh(mesh);
  FileReport out;
  out.json = {{"file", file},
              {"kind", "mesh"},
              {"length_unit", unit.name},
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
  out.text += "  bounds  " + boxText(r.bounds, unit.metres, unit.name) + "\n";
  out.text += "  volume  " + formatNumber(r.volume / std::pow(unit.metres, 3)) + " " + unit.name +
              "^3" + (r.volume < 0.0 ? " (the triangles wind inwards)" : "") + "\n";
  if (!r.isClosed()) {
    out.json["first_boundary_m"] = vectorJson(r.first_boundary);
    out.text += "  open at " + plural(r.boundary_edges, "edge") + ", one of them at " +
                formatVector(r.first_boundary / unit.metres) + " " + unit.name + "\n";
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

/// In the words of a radiologist's axes: "right", "left", ...
std::string axisWords(const std::string& orientation) {
  std::string text;
  for (const char c : orientation) {
    const char* word = c == 'R'   ? "right"
                       : c == 'L' ? "left"
                       : c == 'A' ? "front"
                       : c == 'P' ? "back"
                       : c == 'S' ? "up"
                       : c == 'I' ? "down"
                                  : "?";
    text += (text.empty() ? "" : ", ") + std::string(word);
  }
  return text;
}

FileReport imageInfo(const std::string& file, Console& console) {
  const vdb::ImageInfo info = vdb::readNiftiInfo(file);
  for (const auto& note : info.notes) console.note(file + ": " + note);
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index{0.0};
    for (int i = 0; i < 3; ++i) {
      index[i] = ((corner >> i) & 1) != 0 ? info.size[static_cast<std::size_t>(i)] - 1.0 : 0.0;
    }
    box.include(info.axes * index + info.origin);
  }
  const Vec3 spacing(glm::length(info.axes[0]), glm::length(info.axes[1]),
                     glm::length(info.axes[2]));
  const auto size = std::to_string(info.size[0]) + " x " + std::to_string(info.size[1]) + " x " +
                    std::to_string(info.size[2]);
  FileReport out;
  out.json = {{"file", file},
              {"kind", "image"},
              {"size", info.size},
              {"spacing_m", vectorJson(spacing)},
              {"data_type", info.data_type},
              {"orientation", info.orientation},
              {"axes_m", Json::array({vectorJson(info.axes[0]), vectorJson(info.axes[1]),
                                      vectorJson(info.axes[2])})},
              {"origin_m", vectorJson(info.origin)},
              {"bounds_m", boxJson(box)},
              {"notes", info.notes}};
  out.text = file + ": an image of " + size + " voxels (" + info.data_type + ")\n";
  out.text += "  spacing      " + formatNumber(spacing.x * 1e3) + " x " +
              formatNumber(spacing.y * 1e3) + " x " + formatNumber(spacing.z * 1e3) + " mm\n";
  out.text += "  orientation  " + info.orientation + ": its axes run to the " +
              axisWords(info.orientation) + "\n";
  out.text += "  centres      " + boxText(box, 1e-3, "mm (RAS)") + "\n";
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
        one = meshInfo(file, options.units, console);
        break;
      case InputKind::kImage:
        one = imageInfo(file, console);
        break;
    }
    if (!report.text.empty()) report.text += "\n";
    report.text += one.text;
    report.json["files"].push_back(std::move(one.json));
  }
  return report;
}

}  // namespace palpate::tools
