#include "check/scene_centers.h"

#include <map>

#include "check/file_check.h"
#include "json_parts.h"
#include "palpate/vdb/image.h"

namespace palpate::tools {
namespace {

ImageCenters centersOf(const SceneImage& image, const LoadedScene& loaded, const Scene& scene) {
  ImageCenters out;
  out.image = image.name;
  std::map<int, int> part_of;
  std::map<RegionId, int> part_at;
  for (const LayerDescription& layer : loaded.description().layers) {
    if (layer.label_group != image.name) continue;
    const auto part = static_cast<int>(out.layers.size());
    out.layers.push_back(layer.name);
    part_at[scene.regionNamed(layer.name)] = part;
    for (const int label : layer.labels) part_of[label] = part;  // the later has what is in both
  }
  if (out.layers.empty()) return out;
  vdb::Image voxels;
  try {
    voxels = vdb::readImage(image.file, image.options);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    // The scene loaded, so its grids were baked before: they came with a bundle.
    out.has_voxels = false;
    return out;
  }
  out.centers = vdb::countCenters(voxels, part_of, [&](const Vec3& p) {
    const RegionId region = scene.regionAt(p);
    if (region == kOutside) return vdb::kNoPart;
    const auto found = part_at.find(region);
    return found == part_at.end() ? vdb::kOtherPart : found->second;
  });
  return out;
}

Json countJson(const vdb::CenterCount& count) {
  return {
      {"centers", count.centers}, {"changed", count.changed}, {"against_neighbors", count.against}};
}

std::string countText(const vdb::CenterCount& count) {
  const double share =
      count.centers == 0 ? 0.0
                         : static_cast<double>(count.changed) / static_cast<double>(count.centers);
  return formatCount(count.changed) + " of " + formatCount(count.centers) + " (" +
         formatNumber(100.0 * share, 2) + " %)";
}

}  // namespace

std::vector<ImageCenters> imageCenters(const LoadedScene& loaded, const Scene& scene) {
  std::vector<ImageCenters> all;
  for (const SceneImage& image : loaded.images()) {
    ImageCenters one = centersOf(image, loaded, scene);
    if (!one.layers.empty()) all.push_back(std::move(one));
  }
  return all;
}

Json centersJson(const std::vector<ImageCenters>& all) {
  Json list = Json::array();
  for (const ImageCenters& one : all) {
    Json entry = countJson(one.centers.all);
    entry["image"] = one.image;
    entry["has_voxels"] = one.has_voxels;
    entry["against_at_m"] = one.centers.place ? vectorJson(*one.centers.place) : Json();
    Json layers = Json::array();
    for (const auto& [part, count] : one.centers.parts) {
      Json layer = countJson(count);
      layer["layer"] =
          part == vdb::kNoPart ? Json() : Json(one.layers[static_cast<std::size_t>(part)]);
      layers.push_back(std::move(layer));
    }
    entry["layers"] = std::move(layers);
    list.push_back(std::move(entry));
  }
  return list;
}

std::string centersText(const std::vector<ImageCenters>& all, const LengthUnit& unit) {
  std::string text;
  for (const ImageCenters& one : all) {
    text += "  labels of " + one.image + ": ";
    if (!one.has_voxels) {
      text += "the scan is not there, so its voxels are not looked at\n";
      continue;
    }
    const vdb::CenterCount& count = one.centers.all;
    text += countText(count) + " voxel centers are in another layer than their label's, " +
            formatCount(count.against) + " of them against the majority of their neighbors";
    if (one.centers.place) text += ", one at " + placeText(*one.centers.place, unit);
    text += "\n";
    for (const auto& [part, each] : one.centers.parts) {
      if (each.changed == 0) continue;
      text += "    " +
              (part == vdb::kNoPart ? std::string("around the layers")
                                    : one.layers[static_cast<std::size_t>(part)]) +
              ": " + countText(each) + ", " + formatCount(each.against) + " against the majority\n";
    }
  }
  return text;
}

}  // namespace palpate::tools
