#include "import/models.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <optional>

#include "input_kind.h"
#include "palpate/core/error.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/text.h"
#include "scan_options.h"
#include "text.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kVoxelsAlong = 256.0;

bool isModel(const std::string& path) {
  constexpr const char* kExtensions[] = {".stl", ".obj", ".ply", ".vtk", ".gltf", ".glb"};
  return std::any_of(std::begin(kExtensions), std::end(kExtensions),
                     [&](const char* extension) { return vdb::hasExtension(path, extension); });
}

std::vector<std::string> modelsIn(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string file = entry.path().string();
    const bool is_hidden = vdb::fileName(file).starts_with('.');
    if (!is_hidden && entry.is_regular_file(failed) && isModel(file)) out.push_back(file);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> filesOf(const std::vector<std::string>& scans) {
  std::error_code failed;
  if (scans.size() == 1 && fs::is_directory(scans.front(), failed)) return modelsIn(scans.front());
  return scans;
}

/// The first number that stands alone in a name: 12 in "Model_12_liver", none in "L3".
std::optional<int> numberIn(const std::string& stem) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t begin = 0; begin < stem.size();) {
    if (!is_word(stem[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < stem.size() && is_word(stem[end])) ++end;
    int number = 0;
    const auto read = std::from_chars(stem.data() + begin, stem.data() + end, number);
    if (read.ec == std::errc() && read.ptr == stem.data() + end) return number;
    begin = end;
  }
  return std::nullopt;
}

std::string nameOf(const std::string& file, const vdb::NameTable& table) {
  const std::string stem = stemOf(file);
  if (const std::optional<int> number = numberIn(stem)) {
    if (const auto at = table.find(*number); at != table.end()) return at->second;
  }
  return stem;
}

}  // namespace

bool areModels(const std::vector<std::string>& scans) {
  std::error_code failed;
  if (scans.size() == 1 && fs::is_directory(scans.front(), failed)) {
    return !vdb::isImageFile(scans.front()) && !modelsIn(scans.front()).empty();
  }
  return std::all_of(scans.begin(), scans.end(), isModel);
}

vdb::Image readModels(const ImportOptions& options, Console& console) {
  const vdb::NameTable table =
      options.names.empty() ? vdb::NameTable{} : vdb::readLabelTable(options.names).names;
  std::vector<vdb::NamedMesh> models;
  Box3 box;
  for (const std::string& file : filesOf(options.scans)) {
    vdb::Mesh mesh =
        readMeshFile(file, vdb::prescribedUnit(file).empty() ? "mm" : "", options.reading, console);
    for (const Vec3& v : mesh.vertices) box.include(v);
    models.push_back({nameOf(file, table), std::move(mesh)});
  }
  const Vec3 side = box.size();
  const double voxel = options.voxel.empty() ? std::max({side.x, side.y, side.z}) / kVoxelsAlong
                                             : parseLength(options.voxel, {}, "--voxel");
  if (!(voxel > 0.0)) {
    throw Error(ErrorKind::kUsage, {"usage.import", "--voxel must be greater than 0", ""});
  }
  vdb::Image image = vdb::labelsOfMeshes(models, voxel, options.priority, console.progress());
  for (const std::string& note : image.notes) console.note(note);
  console.note("the models become " + formatCount(image.size[0]) + " x " +
               formatCount(image.size[1]) + " x " + formatCount(image.size[2]) + " voxels of " +
               formatNumber(1e3 * voxel, 3) + " mm (--voxel): surfaces are met within " +
               formatNumber(0.866e3 * voxel, 2) +
               " mm; --min-island closes gaps between models that touch");
  return image;
}

}  // namespace palpate::tools
