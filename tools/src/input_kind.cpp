#include "input_kind.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/text.h"

namespace palpate::tools {
namespace {

constexpr std::array<std::pair<const char*, InputKind>, 10> kExtensions = {{
    {".yaml", InputKind::kScene},
    {".yml", InputKind::kScene},
    {".json", InputKind::kScene},
    {".vdb", InputKind::kGrid},
    {".stl", InputKind::kMesh},
    {".obj", InputKind::kMesh},
    {".ply", InputKind::kMesh},
    {".gltf", InputKind::kMesh},
    {".glb", InputKind::kMesh},
    {".vtk", InputKind::kMesh},
}};

}  // namespace

InputKind inputKind(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) {
    throw inputError("file.missing", "there is no such file", "check the path", path);
  }
  if (vdb::isImageFile(path)) return InputKind::kImage;
  if (std::filesystem::is_directory(path, failed)) {
    throw inputError("file.is_folder", "this is a folder, and holds no DICOM images and no masks",
                     "name a file in it", path);
  }
  for (const auto& [extension, kind] : kExtensions) {
    if (vdb::hasExtension(path, extension)) return kind;
  }
  throw inputError(
      "file.unknown_kind", "cannot tell from its name what this file is",
      "known are scenes (.yaml .yml .json), grids (.vdb), meshes (.stl .obj .ply .vtk .gltf .glb) "
      "and images (.nii .nii.gz .nrrd .nhdr .mha .mhd, folders of DICOM files or of masks)",
      path);
}

std::string stemOf(const std::string& path) {
  const std::string name = vdb::fileName(path);
  for (const std::string two : {".nii.gz", ".seg.nrrd"}) {
    if (vdb::hasExtension(name, two)) return name.substr(0, name.size() - two.size());
  }
  return std::filesystem::path(name).stem().string();
}

}  // namespace palpate::tools
