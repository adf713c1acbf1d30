#include <algorithm>
#include <array>
#include <cmath>

#include "check/file_check.h"
#include "json_parts.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/mesh_defects.h"
#include "scan_options.h"

namespace palpate::tools {
namespace {

/// [m] Sizes between which a hand can feel a shape; a whole body is 2 m long.
constexpr double kSmall = 1e-3;
constexpr double kLarge = 3.0;

struct Checked {
  const CheckOptions& options;
  LengthUnit unit;
  vdb::Mesh mesh;
  vdb::MeshDefects defects;
  std::vector<Finding> findings = {};
};

void findSize(Checked& c) {
  const double size = glm::length(c.defects.bounds.size());
  if (size >= kSmall && size <= kLarge) return;
  std::string better;
  for (const char* const name : {"mm", "cm", "m", "in", "um"}) {
    const double other = size / c.unit.meters * lengthUnit(name).meters;
    if (other >= 10.0 * kSmall && other <= kLarge / 3.0 && better.empty()) better = name;
  }
  c.findings.push_back({"mesh.size",
                        "it is " + formatNumber(size / 1e-3) + " mm across: too " +
                            (size < kSmall ? "small" : "large") + " to be touched as it is" +
                            (better.empty() ? "" : "; is its unit " + better + "? (--units)"),
                        0});
}

void findEdges(Checked& c) {
  const vdb::MeshDefects& d = c.defects;
  if (d.boundary_edges > 0) {
    const vdb::MeshHole& hole = d.holes.front();
    c.findings.push_back({"mesh.holes",
                          countOf(d.holes.size(), "hole", "holes") + " with " +
                              countOf(d.boundary_edges, "edge", "edges") +
                              " that have one triangle; the largest is " +
                              formatNumber(hole.length / c.unit.meters) + " " + c.unit.name +
                              " around, at " + placeText(hole.middle, c.unit),
                          d.holes.size(), hole.middle});
  }
  if (d.non_manifold_edges > 0) {
    c.findings.push_back(
        {"mesh.non_manifold",
         countOf(d.non_manifold_edges, "edge", "edges") + " with three triangles or more",
         d.non_manifold_edges});
  }
}

void findTriangles(Checked& c) {
  const vdb::MeshDefects& d = c.defects;
  const auto triangles = [](std::uint64_t count) {
    return countOf(count, "triangle", "triangles");
  };
  if (d.turned_triangles > 0) {
    c.findings.push_back({"mesh.turned",
                          triangles(d.turned_triangles) + " wound against their neighbors",
                          d.turned_triangles});
  }
  if (d.inside_out_parts > 0) {
    c.findings.push_back({"mesh.inside_out",
                          countOf(d.inside_out_parts, "part is", "parts are") +
                              " inside out: the triangles wind inwards",
                          d.inside_out_parts});
  }
  if (d.doubled_triangles > 0) {
    c.findings.push_back(
        {"mesh.doubled",
         triangles(d.doubled_triangles) + " with the same corners as another triangle",
         d.doubled_triangles});
  }
  const std::size_t degenerate = d.degenerate_triangles + c.mesh.dropped_triangles;
  if (degenerate > 0) {
    c.findings.push_back({"mesh.degenerate", triangles(degenerate) + " without area", degenerate});
  }
  if (d.crossings > 0) {
    c.findings.push_back({"mesh.self_intersection",
                          countOf(d.crossings, "pair", "pairs") +
                              " of triangles that pass through or touch each other, one at " +
                              placeText(d.first_crossing, c.unit),
                          d.crossings, d.first_crossing});
  }
}

/// The result of the trial bake.
struct Trial {
  double voxel = 0.0;   ///< [m]
  double volume = 0.0;  ///< [m^3]
  std::optional<Problem> refused;
};

Trial tryBake(const Checked& c, Console& console) {
  Trial trial;
  const Vec3 size = c.defects.bounds.size();
  trial.voxel = c.options.voxel.empty() ? std::max({size.x, size.y, size.z}) / 128.0
                                        : parseLength(c.options.voxel, c.unit, "--voxel");
  if (!c.options.voxel.empty() && !(trial.voxel > 0.0)) {
    throw Error(ErrorKind::kUsage, {"usage.check", "--voxel must be greater than 0"});
  }
  vdb::BakeOptions bake;
  bake.voxel_size = trial.voxel;
  bake.name = "check";
  try {
    trial.volume = vdb::solidVolume(vdb::bakeMesh(c.mesh, bake, console.progress()));
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    trial.refused = error.problem();
  }
  return trial;
}

}  // namespace

FileCheck checkMeshFile(const std::string& file, const CheckOptions& options, Console& console) {
  const LengthUnit unit = meshUnit(options.units);
  vdb::Mesh mesh = readMeshFile(file, options.units, options.scan, console);
  vdb::MeshDefects defects = vdb::findDefects(mesh, console.progress());
  Checked c{options, unit, std::move(mesh), std::move(defects)};
  findEdges(c);
  findTriangles(c);
  findSize(c);
  const Trial trial = tryBake(c, console);
  const vdb::MeshDefects& d = c.defects;

  FileCheck out;
  out.is_yes = !trial.refused;
  Json holes = Json::array();
  constexpr std::size_t kMostHoles = 100;
  for (std::size_t n = 0; n < std::min(d.holes.size(), kMostHoles); ++n) {
    holes.push_back({{"edges", d.holes[n].edges},
                     {"length_m", d.holes[n].length},
                     {"middle_m", vectorJson(d.holes[n].middle)}});
  }
  out.json = {{"file", file},
              {"kind", "mesh"},
              {"ok", out.is_yes},
              {"length_unit", unit.name},
              {"space", c.mesh.space == vdb::Space::kLps ? "LPS" : "RAS"},
              {"space_stated", c.mesh.space_is_stated},
              {"vertices", c.mesh.vertices.size()},
              {"triangles", c.mesh.triangles.size()},
              {"parts", d.parts},
              {"inside_out_parts", d.inside_out_parts},
              {"hollow_parts", d.hollow_parts},
              {"boundary_edges", d.boundary_edges},
              {"holes", d.holes.size()},
              {"largest_holes", std::move(holes)},
              {"non_manifold_edges", d.non_manifold_edges},
              {"turned_triangles", d.turned_triangles},
              {"doubled_triangles", d.doubled_triangles},
              {"degenerate_triangles", d.degenerate_triangles + c.mesh.dropped_triangles},
              {"self_intersections", d.crossings},
              {"area_m2", d.area},
              {"volume_m3", d.boundary_edges == 0 ? Json(d.volume) : Json()},
              {"bounds_m", boxJson(d.bounds)},
              {"findings", findingsJson(c.findings)},
              {"bake",
               {{"ok", !trial.refused},
                {"voxel_size_m", trial.voxel},
                {"volume_m3", trial.refused ? Json() : Json(trial.volume)},
                {"refused", trial.refused ? problemJson(*trial.refused) : Json()}}}};

  const std::string cube = " " + unit.name + "^3";
  const auto volume_text = [&](double volume) {
    return formatNumber(volume / std::pow(unit.meters, 3)) + cube;
  };
  const Vec3 size = d.bounds.size() / unit.meters;
  out.text = file + ": a mesh of " + countOf(c.mesh.triangles.size(), "triangle", "triangles") +
             " and " + countOf(c.mesh.vertices.size(), "corner", "corners") + " in " +
             countOf(d.parts, "part", "parts") + "\n";
  out.text += "  size    " + formatNumber(size.x) + " x " + formatNumber(size.y) + " x " +
              formatNumber(size.z) + " " + unit.name + "; area " +
              formatNumber(d.area / (unit.meters * unit.meters)) + " " + unit.name + "^2" +
              (d.boundary_edges == 0 ? ", encloses " + volume_text(d.volume) : "") + "\n";
  out.text += "  space   " + spaceText(c.mesh, options.scan) + "\n";
  if (d.hollow_parts > 0) {
    out.text += "  parts   " + countOf(d.hollow_parts, "hollow", "hollows") + " within others\n";
  }
  out.text += findingsText(c.findings, "  ");
  const std::string voxels =
      "with voxels of " + formatNumber(trial.voxel / unit.meters, 3) + " " + unit.name;
  if (trial.refused) {
    out.text += "  no: a bake " + voxels + " refuses it: " + problemText(*trial.refused) + "\n";
  } else {
    out.text += std::string("  yes: ") +
                (c.findings.empty() ? "nothing is wrong; a bake " : "a bake ") + voxels +
                " makes a solid of " + volume_text(trial.volume) + "\n";
  }
  return out;
}

}  // namespace palpate::tools
