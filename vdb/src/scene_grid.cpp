#include "scene_grid.h"

#include <filesystem>
#include <system_error>

#include "palpate/core/error.h"

namespace palpate::vdb {

Sampler readSampler(const MapReader& reader) {
  constexpr Sampler kSamplers[] = {Sampler::kCubic, Sampler::kTrilinear, Sampler::kAccessor};
  return kSamplers[reader.choice("sampler")];
}

std::string readExistingFile(const MapReader& reader, std::string_view key) {
  std::string path = reader.loader().resolvePath(reader.text(key));
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
