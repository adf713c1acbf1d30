#include "loaded_scene.h"

#include <filesystem>
#include <utility>

#include "cache_folder.h"
#include "json_parts.h"
#include "pack/bundle.h"
#include "pack/contents.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::tools {

LoadedScene::LoadedScene(const std::string& file, Console& console, std::uint64_t max_memory,
                         const std::string& text)
    : console_(&console) {
  SceneRegistry registry;
  vdb::RegisterOptions options;
  options.on_grid = [this](const vdb::GridRecord& record) { grids_.push_back(record); };
  options.on_note = [this](const std::string& note) { console_->note(note); };
  options.on_color = [this](const std::string& layer, const vdb::LabelColor& color) {
    colors_[layer] = color;
  };
  SceneImage image;
  options.on_image = [&image](const vdb::ImageRecord& record) {
    image.file = record.file;
    image.options = record.options;
    image.has_names = record.is_labels;
  };
  options.max_memory = max_memory;
  options.cache_folder = cacheFolder();
  vdb::BundleOptions bundle = bundleToFill();
  if (!bundle.fills) bundle.folder = bundleGridsOf(file);
  if (!bundle.fills && !bundle.folder.empty()) {
    checkContents(std::filesystem::path(bundle.folder).parent_path());
  }
  vdb::registerKinds(registry, options, bundle);

  // Pictures need the scans themselves, so this records the entries as they are read.
  registry.image = [this, &image, inner = registry.image](MapReader& reader) {
    auto made = inner(reader);
    for (const auto& entry : reader.loader().document().root.entries) {
      if (entry.key != "images") continue;
      for (const auto& named : entry.value.entries) {
        if (&named.value == &reader.node()) image.name = named.key;
      }
    }
    images_.push_back(std::move(image));
    image = {};
    return made;
  };
  description_ = text.empty() ? readScene(file, registry) : parseScene(text, file, registry);
}

LengthUnit LoadedScene::unit() const {
  return {description_.length_unit, description_.meters_per_unit};
}

ScenePtr LoadedScene::compile(Purpose purpose) const {
  return palpate::compile(description_, console_->progress(), purpose);
}

Json LoadedScene::gridsJson() const {
  Json list = Json::array();
  for (const auto& grid : grids_) {
    const vdb::ScanLoss loss = vdb::scanLoss(grid.info);
    const bool is_whole = loss.lost + loss.filled == 0;
    list.push_back({{"what", grid.what},
                    {"voxel_size_m", grid.info.voxel_size},
                    {"active_voxels", grid.info.active_voxels},
                    {"memory_bytes", grid.info.memory},
                    {"seconds", grid.seconds},
                    {"was_kept", vdb::wasKept(grid.info)},
                    {"lost_voxels", loss.lost},
                    {"filled_voxels", loss.filled},
                    {"lost_at_m", is_whole ? Json() : vectorJson(loss.place)}});
  }
  return list;
}

std::string LoadedScene::lossText() const {
  std::string text;
  for (const auto& grid : grids_) {
    const std::string note = vdb::scanLossNote(grid.info);
    if (!note.empty()) text += "  " + grid.what + ": " + note + "\n";
  }
  return text;
}

Table LoadedScene::gridsTable() const {
  Table table({"grid", "voxel", "active voxels", "memory", "made in"});
  for (const auto& grid : grids_) {
    table.add({grid.what,
               formatNumber(grid.info.voxel_size / description_.meters_per_unit, 3) + " " +
                   description_.length_unit,
               formatCount(grid.info.active_voxels), formatBytes(grid.info.memory),
               formatSeconds(grid.seconds) + (vdb::wasKept(grid.info) ? ", kept" : "")});
  }
  return table;
}

std::string LoadedScene::gridsText() const {
  if (grids_.empty()) return {};
  return gridsTable().text("  ") + lossText();
}

}  // namespace palpate::tools
