#include "scan_options.h"

#include "input_kind.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::tools {
namespace {

vdb::Space spaceOf(const ScanOptions& options) {
  if (options.space == "RAS") return vdb::Space::kRas;
  if (options.space == "LPS") return vdb::Space::kLps;
  return vdb::Space::kStated;
}

}  // namespace

vdb::ImageOptions imageOptions(const ScanOptions& options) {
  vdb::ImageOptions out;
  if (options.affine == "sform") out.affine = vdb::AffineChoice::kSform;
  if (options.affine == "qform") out.affine = vdb::AffineChoice::kQform;
  if (options.affine == "spacing") out.affine = vdb::AffineChoice::kSpacing;
  out.space = spaceOf(options);
  out.frame = options.frame;
  out.series = options.series;
  out.resample = options.resample;
  return out;
}

LengthUnit meshUnit(const std::string& units) { return lengthUnit(units.empty() ? "mm" : units); }

vdb::Mesh readMeshFile(const std::string& file, const std::string& units,
                       const ScanOptions& options, Console& console) {
  refuseScanOptions(options, true);
  const std::string prescribed = units.empty() ? vdb::prescribedUnit(file) : "";
  if (units.empty() && prescribed.empty()) {
    console.note(file + ": one unit is taken as 1 mm; --units changes that");
  }
  const LengthUnit unit = prescribed.empty() ? meshUnit(units) : lengthUnit(prescribed);
  vdb::Mesh mesh = vdb::readMesh(file, unit.meters, spaceOf(options));
  // The note matters for models of scans; other meshes have no patient.
  if (options.space.empty() && (mesh.space_is_stated || vdb::hasExtension(file, ".vtk"))) {
    console.note(file + ": coordinates are taken as " + spaceText(mesh, options) +
                 "; --space changes that");
  }
  return mesh;
}

std::string spaceText(const vdb::Mesh& mesh, const ScanOptions& options) {
  const std::string name = mesh.space == vdb::Space::kLps ? "LPS" : "RAS";
  if (!options.space.empty()) return name + ", as asked";
  return name + (mesh.space_is_stated ? ", as the file says" : ", which the file does not say");
}

void refuseScanOptions(const ScanOptions& options, bool is_mesh) {
  const auto refuse = [](bool given, const char* option, const char* what) {
    if (!given) return;
    throw Error(ErrorKind::kUsage,
                {"usage.scan", std::string(option) + " applies to " + what, "leave it out"});
  };
  refuse(!options.affine.empty(), "--affine", "images");
  refuse(options.frame.has_value(), "--frame", "images");
  refuse(!options.series.empty(), "--series", "DICOM folders");
  refuse(options.resample, "--resample", "DICOM series");
  refuse(!is_mesh && !options.space.empty(), "--space", "meshes and NRRD images");
}

}  // namespace palpate::tools
