#include "fuzz/readers.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/mesh.h"
#include "support/temp_file.h"
#include "vdb/dicom_writer.h"

namespace palpate::fuzz {
namespace {

void readAnyMesh(const std::string& path) {
  const vdb::Mesh mesh = vdb::readMesh(path, 1e-3);
  (void)vdb::checkMesh(mesh);
}
void readAnyImage(const std::string& path) {
  (void)vdb::readImageInfo(path);
  (void)vdb::readImage(path);
}
void readGrids(const std::string& path) {
  (void)vdb::listVdb(path);
  (void)vdb::checkVdb(path);
}
/// With stand-ins for the kinds that palpate::vdb adds: only lib's grammar is tested.
void readSceneFile(const std::string& path) { (void)readScene(path, SceneRegistry{}); }
void readTable(const std::string& path) { (void)vdb::readLabelTable(path); }
void readHandPath(const std::string& path) { (void)devices::readPath(path); }

constexpr Reader kReaders[] = {
    {"yaml", ".yaml", readSceneFile},
    {"path", ".csv", readHandPath},
    {"labels", ".txt", readTable},
    {"nifti", ".nii", readAnyImage},
    {"nifti_gz", ".nii.gz", readAnyImage},
    {"nrrd", ".nrrd", readAnyImage},
    {"metaimage", ".mha", readAnyImage},
    {"dicom", ".dcm", readAnyImage},
    {"stl", ".stl", readAnyMesh},
    {"obj", ".obj", readAnyMesh},
    {"ply", ".ply", readAnyMesh},
    {"vtk", ".vtk", readAnyMesh},
    {"gltf", ".gltf", readAnyMesh},
    {"glb", ".glb", readAnyMesh},
    {"vdb", ".vdb", readGrids},
};

/// A separate folder for the file: a reader of DICOM looks at all files beside it.
const palpate::testing::TempFolder& folder() {
  static const palpate::testing::TempFolder one;
  return one;
}

/// A single slice does not make a volume; with sound slices beside it the pixels are read as well,
/// and structure sets have a series to refer to.
void putMoreSlices(const std::string& own) {
  for (const char* const z : {"1", "2"}) {
    const std::string path = own + "/slice" + z + ".dcm";
    if (std::filesystem::exists(path)) continue;
    vdb::test::DicomFile slice;
    slice.position = std::string("0\\0\\") + z;
    const std::string bytes = bytesOf(slice);
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
}

}  // namespace

std::span<const Reader> readers() { return kReaders; }

const Reader& readerNamed(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kReaders), std::end(kReaders),
                                         [&](const Reader& r) { return r.name == name; });
  if (found == std::end(kReaders)) throw std::out_of_range("no such reader");
  return *found;
}

Outcome readBytes(const Reader& reader, std::string_view bytes) {
  const std::string own = folder().path(reader.name);
  std::filesystem::create_directory(own);
  const std::string path = own + "/input" + reader.extension;
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (std::string_view(reader.name) == "dicom") putMoreSlices(own);
  try {
    reader.read(path);
    return Outcome::kRead;
  } catch (const Error&) {
    return Outcome::kRefused;
  }
}

}  // namespace palpate::fuzz
