#include "scene_grid.h"

#include <filesystem>
#include <system_error>

#include "palpate/core/error.h"

namespace palpate::vdb {

Sampler readSampler(MapReader& reader) {
  const std::string name = reader.textOr("sampler", "cubic");
  if (name == "cubic") return Sampler::kCubic;
  if (name == "trilinear") return Sampler::kTrilinear;
  if (name == "accessor") return Sampler::kAccessor;
  throw reader.errorAt("sampler", "scene.kind", "'sampler' is `" + name + "`",
                       "write sampler: cubic, sampler: trilinear or sampler: accessor");
}

double readPositiveOrNone(MapReader& reader, const char* key) {
  const double length = reader.lengthOr(key, 0.0);
  if (reader.has(key) && !(length > 0.0)) {
    throw reader.errorAt(key, "scene.range", "'" + std::string(key) + "' must be more than 0");
  }
  return length;
}

double readHalfWidth(MapReader& reader, double fallback) {
  const double half_width = reader.numberOr("half_width", fallback);
  if (!(half_width >= 2.0)) {
    throw reader.errorAt("half_width", "scene.range", "'half_width' must be 2 voxels or more");
  }
  return half_width;
}

std::string readExistingFile(MapReader& reader, std::string_view key) {
  std::string path = reader.loader().resolvePath(reader.requireText(key));
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) {
    throw reader.errorAt(key, "scene.no_file", "there is no file " + path,
                         "paths are relative to the folder of the scene");
  }
  if (std::filesystem::is_directory(path, failure)) {
    throw reader.errorAt(key, "scene.no_file", path + " is a directory");
  }
  return path;
}

void throwAt(const SourcePlace& place, const Error& error) {
  const Problem& problem = error.problem();
  if (error.kind() != ErrorKind::kInput || problem.file == place.file) throw error;
  throw errorAt(place, problem.code,
                (problem.file.empty() ? "" : problem.file + ": ") + problem.message, problem.hint);
}

}  // namespace palpate::vdb
