#include "check/file_check.h"
#include "check/scene_centers.h"
#include "loaded_scene.h"
#include "map_coverage.h"
#include "palpate/vdb/scan_surface.h"
#include "wall_notes.h"

namespace palpate::tools {
namespace {

/// Adds notes on parts of a scan that a grid could not hold; they do not keep the scene from being
/// touched.
void findLoss(const vdb::GridRecord& grid, std::vector<Finding>& findings) {
  const vdb::ScanLoss loss = vdb::scanLoss(grid.info);
  if (loss.lost + loss.filled > 0) {
    findings.push_back({"scene.scan_loss", grid.what + ": " + vdb::scanLossNote(grid.info),
                        loss.lost + loss.filled, loss.place});
  }
  const auto parts = grid.info.metadata.find("lost_parts");
  if (parts != grid.info.metadata.end()) {
    findings.push_back({"scene.lost_parts", grid.what + ": not in the grid: " + parts->second});
  }
}

}  // namespace

FileCheck checkSceneFile(const std::string& file, Console& console) {
  const LoadedScene loaded(file, console);
  const ScenePtr scene = loaded.compile();
  std::vector<Finding> findings;
  for (const vdb::GridRecord& grid : loaded.grids()) findLoss(grid, findings);
  for (const MapGap& gap : mapGaps(loaded.description(), *scene)) {
    findings.push_back({gap.misses() ? "scene.map_misses" : "scene.map_partial",
                        gapText(gap, scene->lengthUnit(), scene->metersPerUnit())});
  }
  for (const WallNote& note : wallNotes(*scene)) {
    if (note.is_warning) findings.push_back({note.code, note.text, 1, note.place});
  }
  const std::vector<ImageCenters> centers = imageCenters(loaded, *scene);
  const std::size_t layers = scene->regions().size() - 1;
  FileCheck out;
  out.json = {{"file", file},
              {"kind", "scene"},
              {"ok", true},
              {"layers", layers},
              {"ports", scene->ports().size()},
              {"grids", loaded.gridsJson()},
              {"label_centers", centersJson(centers)},
              {"findings", findingsJson(findings)}};
  out.text = file + ": a scene, " + countOf(layers, "layer", "layers") + ", " +
             countOf(scene->ports().size(), "port", "ports") + ", " +
             countOf(loaded.grids().size(), "grid", "grids") + "\n" +
             centersText(centers, loaded.unit()) + findingsText(findings, "  ") + "  yes\n";
  return out;
}

}  // namespace palpate::tools
