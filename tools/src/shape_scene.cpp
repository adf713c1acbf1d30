#include "shape_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "input_kind.h"
#include "palpate/core/error.h"
#include "palpate/vdb/io.h"
#include "report.h"
#include "scene_text.h"
#include "vdb_grid_name.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.touch", std::move(message), std::move(hint)});
}

void refuse(bool given, const char* option, const char* applies_to) {
  if (given) throw usageError(std::string(option) + " applies to " + applies_to);
}

void refuseImageOptions(const TouchOptions& o) {
  refuse(o.above.has_value(), "--above", "images and grids of densities");
  refuse(o.distances, "--distances", "images");
  refuse(!o.labels.empty(), "--labels", "images");
  refuse(!o.names.empty(), "--names", "images");
  refuse(!o.scan.affine.empty(), "--affine", "images");
  refuse(o.scan.frame.has_value(), "--frame", "images");
  refuse(!o.scan.series.empty(), "--series", "DICOM folders");
  refuse(o.scan.resample, "--resample", "DICOM series");
}

/// A valid name for a layer that is not taken yet.
std::string layerName(std::string text, std::set<std::string>& taken) {
  for (char& c : text) {
    if (std::string_view("*?;,/\"\\").find(c) != std::string_view::npos) c = '_';
  }
  if (text.empty() || text == "outside") text = "shape";
  std::string name = text;
  for (int n = 2; !taken.insert(name).second; ++n) name = text + " " + std::to_string(n);
  return name;
}

/// The sections of a scene while it is put together.
struct Parts {
  std::string fields;
  std::string images;
  std::string layers;
  std::set<std::string> names;

  void addField(const std::string& name, const std::string& field) {
    const std::string layer = layerName(name, names);
    fields += "  " + sceneWord(layer) + ": " + field + "\n";
    layers +=
        "  - {name: " + sceneWord(layer) + ", inside: " + sceneWord(layer) + ", wall: wall}\n";
  }
  [[nodiscard]] std::string text() const {
    std::string out = "palpate: 1\nlength: mm\n";
    if (!fields.empty()) out += "fields:\n" + fields;
    if (!images.empty()) out += "images:\n" + images;
    return out + "materials:\n  wall: {stiffness: 500 N/m}\nlayers:\n" + layers;
  }
};

/// `{key: value, ...}` of the values that are given.
class Entries {
 public:
  void add(const std::string& key, const std::string& value) {
    if (!value.empty()) text_ += (text_.empty() ? "" : ", ") + key + ": " + value;
  }
  void addText(const std::string& key, const std::string& value) {
    if (!value.empty()) add(key, sceneWord(value));
  }
  [[nodiscard]] std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

/// A length as a scene in mm writes it: without a unit.
std::string voxelOf(const TouchOptions& o) {
  if (o.voxel.empty()) return "";
  const double voxel = parseLength(o.voxel, {"mm", 1e-3}, "--voxel");
  if (!(voxel > 0.0)) throw usageError("--voxel must be greater than 0");
  return formatNumber(voxel * 1e3, 9);
}

void addMesh(const TouchOptions& o, const std::string& file, Parts& parts) {
  refuseImageOptions(o);
  refuse(!o.layer.empty(), "--layer", "grids");
  Entries mesh;
  mesh.addText("file", file);
  mesh.addText("units", o.units);
  mesh.addText("space", o.scan.space);
  mesh.add("voxel", voxelOf(o));
  parts.addField(stemOf(o.scene), "{mesh: " + mesh.text() + "}");
}

void addImage(const TouchOptions& o, const std::string& file, Parts& parts) {
  refuse(!o.units.empty(), "--units", "meshes; an image says where its voxels are");
  refuse(!o.layer.empty(), "--layer", "grids");
  const int asked_for = (o.above ? 1 : 0) + (o.distances ? 1 : 0) + (o.labels.empty() ? 0 : 1);
  if (asked_for != 1) {
    throw usageError(asked_for > 1 ? "--above, --labels and --distances exclude one another"
                                   : "an image needs --above VALUE, --labels NAME,... or "
                                     "--distances to be a shape");
  }
  refuse(o.labels.empty() && !o.names.empty(), "--names", "--labels");
  Entries image;
  image.addText("file", file);
  image.addText("names", o.names.empty() ? "" : fs::absolute(o.names).string());
  image.addText("affine", o.scan.affine);
  image.addText("space", o.scan.space);
  if (o.scan.frame) image.add("frame", std::to_string(*o.scan.frame));
  image.addText("series", o.scan.series);
  if (o.scan.resample) image.add("resample", "true");
  parts.images += "  scan: " + image.text() + "\n";
  const auto add_layer = [&](const std::string& name, const std::string& kind, Entries surface) {
    surface.add("voxel", voxelOf(o));
    parts.layers += "  - {name: " + sceneWord(layerName(name, parts.names)) + ", " + kind + ": " +
                    surface.text() + ", wall: wall}\n";
  };
  if (o.labels.empty()) {
    Entries surface;
    surface.add("image", "scan");
    if (o.above) surface.add("above", formatNumber(*o.above, 17));
    if (o.distances) {
      surface.add("below", "0");
      surface.add("keep", "all");
    }
    add_layer(stemOf(o.scene), "threshold", surface);
  }
  for (const std::string& label : o.labels) {
    const bool is_value = label.find_first_not_of("0123456789") == std::string::npos;
    Entries surface;
    surface.add("image", "scan");
    surface.add("match", "[" + (is_value ? label : sceneWord(label)) + "]");
    add_layer(is_value ? "label " + label : label, "labels", surface);
  }
}

void addGrid(const TouchOptions& o, const std::string& file, Parts& parts) {
  refuse(o.distances, "--distances", "images");
  refuse(!o.labels.empty(), "--labels", "images");
  refuse(!o.names.empty(), "--names", "images");
  refuse(!o.scan.affine.empty() || !o.scan.space.empty(), "--affine and --space",
         "images and meshes");
  const std::string asked = gridName(o.scene, o.layer);
  constexpr std::string_view kEnd = "/surface";
  const std::vector<vdb::VdbGridSummary> grids = vdb::listVdb(o.scene);
  bool found = false;
  for (const vdb::VdbGridSummary& grid : grids) {
    if (asked.empty() ? grid.name == "united" || grid.name == "united/surface"
                      : grid.name != asked) {
      continue;
    }
    const bool is_mask = o.above.has_value() || grid.type == "BoolGrid" || grid.type == "MaskGrid";
    // Besides surfaces a file may hold maps of materials, which are not shapes.
    if (asked.empty() && grids.size() > 1 && !is_mask && grid.grid_class != "level set") continue;
    found = true;
    std::string layer = grid.name.empty() ? stemOf(o.scene) : grid.name;
    if (layer.ends_with(kEnd)) layer.resize(layer.size() - kEnd.size());
    Entries entry;
    entry.addText("file", file);
    entry.addText("name", grid.name);
    entry.addText("units", o.units);
    if (is_mask) {
      if (o.above) entry.add("above", formatNumber(*o.above, 17));
      entry.add("voxel", voxelOf(o));
    } else {
      refuse(!o.voxel.empty(), "--voxel", "meshes, images and --above; a level set has its own");
    }
    parts.addField(layer, (is_mask ? "{mask: " : "{grid: ") + entry.text() + "}");
  }
  if (found) return;
  if (!asked.empty()) {
    throw inputError("vdb.no_grid", "there is no grid '" + asked + "'",
                     "`palpate info` lists the grids of a file", o.scene);
  }
  throw inputError(
      "vdb.class", "none of its " + std::to_string(grids.size()) + " grids is a level set",
      "--layer NAME with --above DENSITY puts a surface around what is denser", o.scene);
}

/// The first point inside a field on the line down through (x, y), if there is one.
std::optional<SurfacePoint> meetFromAbove(const Field& field, const Box3& box, double x, double y) {
  const double step = std::max(1e-4 * glm::length(box.size()), 0.25 * field.featureSize());
  double above = box.hi.z + step;
  double below = above;
  // Far from the surface a grid's value is a lower bound of the distance, so that no step goes too
  // far.
  for (double z = above; z > box.lo.z - step;) {
    const double value = field.value({x, y, z});
    below = z;
    if (!(value > 0.0)) break;
    above = z;
    z -= std::max(0.25 * value / std::max(1.0, field.lipschitz()), step);
    below = kInfinity;
  }
  if (!std::isfinite(below)) return {};
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (above + below);
    (field.value({x, y, middle}) > 0.0 ? above : below) = middle;
  }
  const Vec3 place(x, y, above);
  const FieldSample sample = field.sample(place);
  if (!sample.in_band) return {};
  return SurfacePoint{place, unitOr(sample.gradient, Vec3(0.0, 0.0, 1.0))};
}

}  // namespace

bool isShape(const std::string& path) { return inputKind(path) != InputKind::kScene; }

std::string shapeSceneText(const TouchOptions& options) {
  Parts parts;
  const std::string file = fs::absolute(options.scene).lexically_normal().string();
  switch (inputKind(options.scene)) {
    case InputKind::kMesh:
      addMesh(options, file, parts);
      break;
    case InputKind::kImage:
      addImage(options, file, parts);
      break;
    case InputKind::kGrid:
      addGrid(options, file, parts);
      break;
    case InputKind::kScene:
      break;
  }
  return parts.text();
}

void refuseShapeOptions(const TouchOptions& o) {
  refuseImageOptions(o);
  const char* shapes = "meshes, images and grids; a scene says it itself";
  refuse(!o.units.empty(), "--units", shapes);
  refuse(!o.layer.empty(), "--layer", shapes);
  refuse(!o.voxel.empty(), "--voxel", shapes);
  refuse(!o.scan.space.empty(), "--space", shapes);
  refuse(!o.write_scene.empty(), "--write-scene", shapes);
}

SurfacePoint findSurfacePoint(const Scene& scene) {
  const Box3 box = scene.bounds();
  constexpr int kLines = 33;
  std::vector<std::pair<double, Vec3>> lines;  // sorted by distance from the middle
  for (int i = 0; i < kLines && box.isBounded(); ++i) {
    for (int j = 0; j < kLines; ++j) {
      const Vec3 share((i + 0.5) / kLines, (j + 0.5) / kLines, 0.5);
      lines.emplace_back(glm::distance(share, Vec3(0.5)), box.lo + share * box.size());
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::optional<SurfacePoint> steep;
  for (const auto& [distance, at] : lines) {
    std::optional<SurfacePoint> highest;
    for (const Region& region : scene.regions()) {
      if (!region.field) continue;
      const auto here = meetFromAbove(*region.field, box, at.x, at.y);
      if (here && (!highest || here->place.z > highest->place.z)) highest = here;
    }
    if (!highest) continue;
    if (highest->normal.z > 0.5) return *highest;
    if (!steep) steep = highest;
  }
  if (steep) return *steep;
  throw Error(ErrorKind::kOperation,
              {"touch.no_surface", "no line from above meets a surface of this shape",
               "say where to touch it: --press X,Y,Z --normal X,Y,Z"});
}

}  // namespace palpate::tools
